import { describe, expect, it } from 'vitest';
import {
  broken,
  nearestRow,
  placeText,
  scaleBar_m,
  trackOf,
} from '../../../src/store/logs/log_track';

const series = {
  position_source: 'GPS',
  attitude_source: null,
  vehicle: '',
  run: 0,
  georeferenced: true,
  position_count: 2,
  attitude_count: 0,
  positions: { t_s: [1, 2], lat_deg: [47, 47.001], lon_deg: [8, 8.001], alt_msl_m: [1, 2] },
  speeds: {},
  attitudes: {},
  steps: [],
};

describe('the track of a log', () => {
  it('has the metres of WGS84', () => {
    const track = trackOf(series);
    expect(track.north_m[1]).toBeCloseTo(111.17, 1);
    expect(track.east_m[1]).toBeCloseTo(76.06, 1);
    expect(placeText(track, track.east_m[1] ?? 0, track.north_m[1] ?? 0)).toBe(
      'E 76 m, N 111 m · 47.001000°, 8.001000°',
    );
  });

  it('crosses the antimeridian', () => {
    const positions = { t_s: [1, 2], lat_deg: [0, 0], lon_deg: [179.999, -179.999] };
    const { east_m } = trackOf({ ...series, positions });
    expect(east_m[1]).toBeCloseTo(222.6, 0);
  });

  it('of an unknown place counts from its origin', () => {
    const positions = { t_s: [0], north_m: [5], east_m: [7], above_origin_m: [1] };
    const track = trackOf({ ...series, georeferenced: false, positions });
    expect(track.origin).toBeNull();
    expect(placeText(track, 7, 5)).toBe('E 7 m, N 5 m');
  });

  it('has a round scale bar', () => {
    expect(scaleBar_m(1700)).toBe(1000);
    expect(scaleBar_m(0.3)).toBeCloseTo(0.2);
    expect(scaleBar_m(999)).toBe(500);
  });

  it('finds the nearest row', () => {
    expect(nearestRow([], 1)).toBe(-1);
    expect(nearestRow([1, 2, 4], 2.9)).toBe(1);
    expect(nearestRow([1, 2, 4], 3.1)).toBe(2);
    expect(nearestRow([1, 2, 4], 99)).toBe(2);
  });

  it('breaks lines across gaps and where an angle wraps', () => {
    const times = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 40];
    expect(broken(times, times, false).values.filter((value) => value === null)).toHaveLength(1);
    expect(broken([0, 1, 2], [170, -170, -160], true).values).toEqual([170, null, -170, -160]);
    expect(broken([0, 1, 2], [170, -170, -160], false).values).toEqual([170, -170, -160]);
  });
});
