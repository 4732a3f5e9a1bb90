import { describe, expect, it } from 'vitest';
import { flyableSources, logOverrides, newLogFlight } from '../../../src/store/logs/log_flight';

const document = {
  estimators: [{ name: 'feature', type: 'feature', parameters: { features: 9 } }],
};

describe('a log as a flight', () => {
  it('is smoothed and moved into the world by default', () => {
    const { overrides, errors } = logOverrides(newLogFlight('course'), '/a.bin', document);
    expect(errors).toEqual([]);
    expect(overrides).toEqual({
      title: 'Log a.bin',
      flight: {
        log: { file: '/a.bin', smooth: {}, rebase: { lowest_agl_m: 100, turn_deg: 0 } },
      },
      estimators: document.estimators,
    });
  });

  it('takes the slice, the source and the offsets', () => {
    const flight = {
      ...newLogFlight('course'),
      source: 'GPS',
      from_s: 10,
      to_s: 20.5,
      autoOffset: true,
      rebase: false,
      geoid_separation_m: '-33',
      estimators: ['perfect'],
    };
    const { overrides } = logOverrides(flight, '/a.bin', {
      ...document,
      duration_s: 5,
      start_s: 3,
    });
    expect(overrides).toEqual({
      title: 'Log a.bin',
      flight: {
        log: {
          file: '/a.bin',
          source: 'GPS',
          from_s: 10,
          to_s: 20.5,
          smooth: {},
          time_offset_s: 'auto',
          geoid_separation_m: -33,
        },
      },
      estimators: [{ name: 'perfect', type: 'perfect' }],
      duration_s: 86400,
      start_s: 0,
    });
  });

  it('names the field that is no number', () => {
    const flight = { ...newLogFlight('course'), lowest_agl_m: '', geoid_separation_m: 'x' };
    const { errors } = logOverrides(flight, '/a.bin', {});
    expect(errors.map(({ field }) => field)).toEqual([
      'flight.log.geoid_separation_m',
      'flight.log.rebase.lowest_agl_m',
    ]);
  });

  it('needs positions of a known place', () => {
    const stream = { vehicle: '', messages: 1, rate_hz: 1, first_s: 0, last_s: 1, gaps: 0 };
    const info = {
      name: '',
      format: '',
      size_bytes: 0,
      truth: null,
      on_ground: false,
      streams: [
        { ...stream, name: 'A', longest_gap_s: 0, positions: 3, georeferenced: true },
        { ...stream, name: 'B', longest_gap_s: 0, positions: 3, georeferenced: false },
        { ...stream, name: 'C', longest_gap_s: 0 },
      ],
      events: [],
      warnings: [],
    };
    expect(flyableSources(info)).toEqual(['A']);
  });
});
