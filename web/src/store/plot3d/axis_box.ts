// The axes of the 3D plot: a box with round numbers around all tracks, and its ticks.
import { niceStep } from '../plots/path_frame';
import { sharedExtent } from '../plots/shared_extent';

/** East, north, up [m]. */
export type Point3 = readonly [number, number, number];

export interface Box3 {
  min: [number, number, number];
  max: [number, number, number];
}

export interface AxisScale {
  low: number;
  high: number;
  step: number;
  /** From `low` to `high`. */
  ticks: readonly number[];
}

/** Those of east, north and up. */
export type AxisScales = readonly [AxisScale, AxisScale, AxisScale];

const kMostSteps = 14;
const kMostStepsUp = 5;
/** A box around an aircraft that stands. */
const kLeast_m = 2;

/** The box enlarged so that it contains a place. */
export function enclosed(box: Box3 | null, [x, y, z]: Point3): Box3 {
  if (box === null) return { min: [x, y, z], max: [x, y, z] };
  const { min, max } = box;
  return {
    min: [Math.min(min[0], x), Math.min(min[1], y), Math.min(min[2], z)],
    max: [Math.max(max[0], x), Math.max(max[1], y), Math.max(max[2], z)],
  };
}

/** Encloses all tracks but those that have diverged (`beyond`: their places); null without any point. */
export function boxOfAll(
  tracks: readonly { box: Box3 | null; estimate: boolean }[],
): { box: Box3; beyond: number[] } | null {
  const extents = tracks.map(({ box, estimate }) =>
    box === null ? null : { low: box.min, high: box.max, estimate },
  );
  const shared = sharedExtent(extents, kLeast_m);
  if (shared === null) return null;
  const [x0 = 0, y0 = 0, z0 = 0] = shared.low;
  const [x1 = 0, y1 = 0, z1 = 0] = shared.high;
  return { box: { min: [x0, y0, z0], max: [x1, y1, z1] }, beyond: shared.beyond };
}

/**
 * East and north have one step. That of the height is no less than a third of it as it is drawn, so that the
 * numbers of a flat flight do not cover each other.
 * @param heightScale  by which heights are exaggerated
 */
export function axisScales({ min, max }: Box3, heightScale: number): AxisScales {
  const across_m = Math.max(max[0] - min[0], max[1] - min[1], kLeast_m);
  const step = niceStep(across_m / kMostSteps);
  const upStep = niceStep(Math.max((max[2] - min[2]) / kMostStepsUp, step / (3 * heightScale)));
  return [
    axisScale(min[0], max[0], step),
    axisScale(min[1], max[1], step),
    axisScale(min[2], max[2], upStep),
  ];
}

function axisScale(min: number, max: number, step: number): AxisScale {
  const first = Math.floor(min / step + 1e-9);
  const last = Math.max(first + 1, Math.ceil(max / step - 1e-9));
  const ticks = Array.from({ length: last - first + 1 }, (_, i) => (first + i) * step);
  return { low: first * step, high: last * step, step, ticks };
}

export function boxOfScales([x, y, z]: AxisScales): Box3 {
  return { min: [x.low, y.low, z.low], max: [x.high, y.high, z.high] };
}
