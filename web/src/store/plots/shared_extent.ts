// What the axes of a plot enclose: everything but estimates that have diverged, next to which all other
// curves would be one line.
import type { Polyline } from './curve';
import type { Span } from '../playback/time_window';

/** What a curve or a track covers: an interval for each axis. */
export interface Extent {
  low: readonly number[];
  high: readonly number[];
  /** Only estimates can be left out. */
  estimate: boolean;
}

export interface SharedExtent {
  low: readonly number[];
  high: readonly number[];
  /** Places in the list of those that are left out. */
  beyond: number[];
}

/** Times as large as all others together, an estimate has diverged: next to a truth, */
const kMostNextToTruth = 100;
/** and in plots of errors, where that of a good estimate is close to 0. */
const kMostWithoutTruth = 1e4;

/**
 * The extent of all curves without the estimates that have diverged. If nothing else is shown, such an estimate
 * is shown whole.
 * @param extents  of the curves; null = without values
 * @param least  smaller extents count as this large
 */
export function sharedExtent(
  extents: readonly (Extent | null)[],
  least: number,
): SharedExtent | null {
  const known = extents.flatMap((extent, place) => (extent === null ? [] : [{ extent, place }]));
  const fixed = known.filter(({ extent }) => !extent.estimate);
  let shared = fixed.reduce<Extent | null>((all, { extent }) => union(all, extent), null);
  const most = shared === null ? kMostWithoutTruth : kMostNextToTruth;
  const estimates = known
    .filter(({ extent }) => extent.estimate)
    .map((one) => ({ ...one, size: sizeOf(union(shared, one.extent)) }))
    .sort((a, b) => a.size - b.size);
  const beyond: number[] = [];
  for (const { extent, place } of estimates) {
    const wider = union(shared, extent);
    const diverged = shared !== null && sizeOf(wider) > most * Math.max(sizeOf(shared), least);
    if (diverged) beyond.push(place);
    else shared = wider;
  }
  return shared === null ? null : { low: shared.low, high: shared.high, beyond };
}

/** Of a curve's values in a span of time; null without any. */
export function curveExtent(
  { t_s, values }: Polyline,
  [begin_s, end_s]: Span,
  estimate: boolean,
): Extent | null {
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0; i < t_s.length; i += 1) {
    const t = t_s[i] ?? NaN;
    const value = values[i] ?? NaN;
    if (t < begin_s || t > end_s) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low > high ? null : { low: [low], high: [high], estimate };
}

/** Says that an estimate is left out. */
export function beyondText(name: string): string {
  return `${name} leaves the plot`;
}

/** Of a file's legend, which says of those that are left out that they are. */
export function legendNames<T extends { name: string }>(
  curves: readonly T[],
  beyond: readonly number[],
): T[] {
  return curves.map((curve, i) =>
    beyond.includes(i) ? { ...curve, name: beyondText(curve.name) } : curve,
  );
}

function union(a: Extent | null, b: Extent): Extent {
  if (a === null) return b;
  return {
    low: a.low.map((value, axis) => Math.min(value, b.low[axis] ?? value)),
    high: a.high.map((value, axis) => Math.max(value, b.high[axis] ?? value)),
    estimate: a.estimate && b.estimate,
  };
}

/** Along the longest axis. */
function sizeOf({ low, high }: Extent): number {
  return Math.max(...low.map((value, axis) => (high[axis] ?? value) - value));
}
