import { describe, expect, it } from 'vitest';
import { readFaults } from '../../src/protocol/faults';

describe('readFaults', () => {
  it('keeps the limit and leaves out field and value, which the form shows', () => {
    const message = 'flight.course.airspeed_m_s = 999: must be in [5, 80]';
    expect(readFaults([{ field: 'flight.course.airspeed_m_s', message }])).toEqual([
      { field: 'flight.course.airspeed_m_s', message: 'must be in [5, 80]' },
    ]);
  });

  it('keeps a message of another form whole', () => {
    const fault = { field: 'world', message: 'world: must be given' };
    expect(readFaults([fault])).toEqual([fault]);
  });

  it.each([undefined, null, 'x', [null], [{ field: 1, message: 'a' }], [{}]])(
    'reads nothing from %j',
    (faults) => {
      expect(readFaults(faults)).toEqual([]);
    },
  );
});
