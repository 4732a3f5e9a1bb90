import { describe, expect, it } from 'vitest';
import { parseFaults } from '../../src/protocol/faults';

describe('parseFaults', () => {
  it('splits field and limit, one fault a line', () => {
    expect(
      parseFaults(
        'flight.course.airspeed_m_s = 99: must be in [5, 60]\nestimators.0.type = "x": must be one of a, b',
      ),
    ).toEqual([
      { field: 'flight.course.airspeed_m_s', message: 'must be in [5, 60]' },
      { field: 'estimators.0.type', message: 'must be one of a, b' },
    ]);
  });

  it('keeps a line without a field as it is', () => {
    expect(parseFaults('The disk is full.\n')).toEqual([
      { field: '', message: 'The disk is full.' },
    ]);
  });
});
