import { describe, expect, it } from 'vitest';
import { kGap_s } from '../../../src/store/plot3d/display_track';
import { nearestOnTrack } from '../../../src/store/plot3d/track_pick';

/** x to the right, z up, one pixel a metre. */
const map = { x_px: [1, 0, 0, 0], y_px: [0, 0, -1, 0] } as const;

function track(points: [x: number, z: number, t_s: number][]) {
  return {
    points: new Float32Array(points.flatMap(([x, z, t_s]) => [x, 77, z, t_s, 0])),
    count: points.length,
  };
}

describe('the place of a track under the mouse', () => {
  const bent = track([
    [0, 0, 10],
    [100, 0, 20],
    [100, -100, 30],
  ]);

  it('is on the nearest line, its time between those of the ends', () => {
    const place = nearestOnTrack(bent, map, [25, 3], 10);
    expect(place?.t_s).toBeCloseTo(12.5);
    expect(place?.off_px).toBeCloseTo(3);
    expect(nearestOnTrack(bent, map, [96, 50], 10)?.t_s).toBeCloseTo(25);
  });

  it('is an end beyond it', () => {
    expect(nearestOnTrack(bent, map, [-3, -4], 10)).toEqual({ t_s: 10, off_px: 5 });
  });

  it('is none far away or on an empty track', () => {
    expect(nearestOnTrack(bent, map, [50, 30], 10)).toBeNull();
    expect(nearestOnTrack({ ...bent, count: 0 }, map, [0, 0], 10)).toBeNull();
  });

  it('is not in a gap', () => {
    const broken = track([
      [0, 0, 1],
      [10, 0, 2],
      [10, 0, kGap_s],
      [90, 0, 3],
      [100, 0, 4],
    ]);
    expect(nearestOnTrack(broken, map, [50, 0], 20)).toBeNull();
    expect(nearestOnTrack(broken, map, [15, 0], 20)).toEqual({ t_s: 2, off_px: 5 });
    expect(nearestOnTrack(broken, map, [84, 0], 20)).toEqual({ t_s: 3, off_px: 6 });
  });

  it('is found where an aircraft stands, seen from the end of a line', () => {
    const still = track([
      [5, 5, 1],
      [5, 5, 2],
    ]);
    expect(nearestOnTrack(still, map, [5, -5], 3)?.off_px).toBe(0);
  });
});
