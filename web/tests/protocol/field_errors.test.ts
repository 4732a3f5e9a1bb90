import { describe, expect, it } from 'vitest';
import { readFieldErrors } from '../../src/protocol/field_errors';

describe('readFieldErrors', () => {
  it('keeps the limit and leaves out field and value, which the form shows', () => {
    const message = 'flight.course.airspeed_m_s = 999: must be in [5, 80]';
    expect(readFieldErrors([{ field: 'flight.course.airspeed_m_s', message }])).toEqual([
      { field: 'flight.course.airspeed_m_s', message: 'must be in [5, 80]' },
    ]);
  });

  it('keeps a message of another form whole', () => {
    const entry = { field: 'world', message: 'world: must be given' };
    expect(readFieldErrors([entry])).toEqual([entry]);
  });

  it.each([undefined, null, 'x', [null], [{ field: 1, message: 'a' }], [{}]])(
    'reads nothing from %j',
    (entries) => {
      expect(readFieldErrors(entries)).toEqual([]);
    },
  );
});
