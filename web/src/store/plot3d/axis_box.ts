// The axes of the 3D plot: a box with round numbers around all tracks, and its ticks.
import { niceStep } from '../plots/path_frame';

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

/** Encloses all boxes; null without any. */
export function boxOfAll(boxes: readonly (Box3 | null)[]): Box3 | null {
  return boxes.reduce(
    (all, box) => (box === null ? all : enclosed(enclosed(all, box.min), box.max)),
    null,
  );
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
