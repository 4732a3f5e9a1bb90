// The place of a track that is nearest to a pixel of the 3D plot.
import { kGap_s, kPointSize } from './display_track';
import type { ScreenMap } from './orbit_view';

export interface PickedPlace {
  /** Of the run. */
  t_s: number;
  off_px: number;
}

/**
 * The nearest place on the lines that are drawn; null if none is nearer than `most_px`. Along a line the
 * time is interpolated.
 */
export function nearestOnTrack(
  { points, count }: { points: Float32Array; count: number },
  { x_px, y_px }: ScreenMap,
  [at_x, at_y]: readonly [number, number],
  most_px: number,
): PickedPlace | null {
  let found: PickedPlace | null = null;
  let least2 = most_px * most_px;
  let [x0, y0, t0] = [0, 0, kGap_s];
  for (let i = 0; i < count * kPointSize; i += kPointSize) {
    const [x, y, z] = [points[i] ?? NaN, points[i + 1] ?? NaN, points[i + 2] ?? NaN];
    const t1 = points[i + 3] ?? kGap_s;
    const x1 = x_px[0] * x + x_px[1] * y + x_px[2] * z + x_px[3] - at_x;
    const y1 = y_px[0] * x + y_px[1] * y + y_px[2] * z + y_px[3] - at_y;
    if (t1 !== kGap_s) {
      const joined = t0 !== kGap_s;
      const [dx, dy] = joined ? [x1 - x0, y1 - y0] : [0, 0];
      const length2 = dx * dx + dy * dy;
      // 1 = at this point, 0 = at the one before.
      const share = length2 > 0 ? clamped(-(x0 * dx + y0 * dy) / length2) : 1;
      const off2 = (x1 - dx * (1 - share)) ** 2 + (y1 - dy * (1 - share)) ** 2;
      if (off2 < least2) {
        least2 = off2;
        found = { t_s: joined ? t0 + (t1 - t0) * share : t1, off_px: Math.sqrt(off2) };
      }
    }
    [x0, y0, t0] = [x1, y1, t1];
  }
  return found;
}

function clamped(share: number): number {
  return Math.min(1, Math.max(0, share));
}
