import { describe, expect, it } from 'vitest';
import type { Run } from '../../../src/protocol/rest_types';
import { kReading, runOutcome } from '../../../src/store/errors/run_outcome';
import { kNothing } from '../../../src/store/format';
import { playbackMessage, sampleRun } from '../../support/samples';

const instant = playbackMessage().runs['r1'] ?? null;
const of = (change: Partial<Run>, outcome: string, here = instant) =>
  runOutcome(
    { run: sampleRun(change), instant: here },
    { name: 'x', outcome, good: outcome === 'COMPLETED' },
  );

describe('runOutcome', () => {
  it('is that of a completed flight', () => {
    expect(of({}, 'COMPLETED')).toEqual({ text: 'COMPLETED', good: true });
    expect(of({}, 'LOST at 3.0 s')).toEqual({ text: 'LOST at 3.0 s', good: false });
  });

  it('judges no estimator by a flight that did not reach its end', () => {
    const status = 'failed';
    expect(of({ status, frames: 0 }, 'NOT_INITIALISED')).toEqual({ text: 'not flown', good: null });
    expect(of({ status }, 'LOST').text).toBe('LOST, flight failed');
    expect(of({ status: 'cancelled' }, 'COMPLETED')).toEqual({
      text: 'COMPLETED, flight cancelled',
      good: null,
    });
    expect(of({ status }, kNothing).text).toBe('flight failed');
  });

  it('distinguishes a score that is being read from a missing one', () => {
    expect(of({}, kNothing, null)).toEqual({ text: kReading, good: null });
    expect(of({}, kNothing).text).toBe('not scored yet');
    expect(of({ status: 'running' }, kNothing).text).toBe('not scored yet');
  });
});
