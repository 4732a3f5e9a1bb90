import { describe, expect, it } from 'vitest';
import { distinguishingNames } from '../../src/store/run_names';
import { sampleRun } from '../support/samples';

const flight = (airspeed: number) => `course: ${airspeed} m/s, 45 deg/s, 300 m above the ground`;

describe('distinguishingNames', () => {
  it('says only what differs', () => {
    const names = distinguishingNames([
      sampleRun({ id: 'a', flight: flight(15) }),
      sampleRun({ id: 'b', flight: flight(25), seed: 7 }),
    ]);
    expect([...names.values()]).toEqual(['course: 15 m/s, seed 1', 'course: 25 m/s, seed 7']);
  });

  it('falls back to the whole flight where kinds differ', () => {
    const names = distinguishingNames([
      sampleRun({ id: 'a', flight: flight(15) }),
      sampleRun({ id: 'b', flight: 'log flight.bin' }),
    ]);
    expect(names.get('b')).toBe('log flight.bin');
  });

  it('adds the start where nothing else differs', () => {
    const names = distinguishingNames([
      sampleRun({ id: 'a', created_utc: '2026-01-02T03:04:05' }),
      sampleRun({ id: 'b', created_utc: '2026-01-02T04:04:05' }),
    ]);
    expect([...names.values()]).toEqual(['2026-01-02 03:04', '2026-01-02 04:04']);
  });
});
