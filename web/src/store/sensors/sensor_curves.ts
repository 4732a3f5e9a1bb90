// Curves of one plot on a common time axis.
import type { SensorCurve } from '../../protocol/sensor_types';
import { lastAtOrBefore } from '../table';

/** Rows of times; null breaks a curve, undefined means that it has no value at that time. */
export interface CurveTable {
  t_s: Float64Array;
  curves: (number | null | undefined)[][];
}

const pauses = new WeakMap<readonly number[], number>();

/** A pause longer than this between values is a gap: several times the usual distance [s]. */
export function longestPause_s(t_s: readonly number[]): number {
  const known = pauses.get(t_s);
  if (known !== undefined) return known;
  const steps = t_s.slice(1).map((t, i) => t - (t_s[i] ?? t));
  steps.sort((a, b) => a - b);
  const pause_s = 5 * (steps[Math.floor(steps.length * 0.9)] ?? Infinity);
  pauses.set(t_s, pause_s);
  return pause_s;
}

/** @param per_unit  what the values are divided by */
export function curveTable(curves: readonly SensorCurve[], per_unit: number): CurveTable {
  const broken = curves.map((curve) => withGaps(curve, per_unit));
  const t_s = [...new Set(broken.flatMap((points) => points.map(([t]) => t)))];
  t_s.sort((a, b) => a - b);
  const rowOf = new Map(t_s.map((t, row) => [t, row]));
  return {
    t_s: Float64Array.from(t_s),
    curves: broken.map((points) => {
      const values = new Array<number | null | undefined>(t_s.length).fill(undefined);
      for (const [t, value] of points) values[rowOf.get(t) ?? 0] = value;
      return values;
    }),
  };
}

/** The last value at or before a time; null where there is none, or only one before a gap. */
export function valueAt({ t_s, values }: SensorCurve, time_s: number): number | null {
  const row = lastAtOrBefore(t_s, time_s);
  if (row < 0) return null;
  return time_s - (t_s[row] ?? time_s) > longestPause_s(t_s) ? null : (values[row] ?? null);
}

function withGaps({ t_s, values }: SensorCurve, per_unit: number): [number, number | null][] {
  const longest_s = longestPause_s(t_s);
  return t_s.flatMap((t, i): [number, number | null][] => {
    const before = t_s[i - 1] ?? t;
    const point: [number, number | null] = [t, (values[i] ?? 0) / per_unit];
    return t - before > longest_s ? [[(t + before) / 2, null], point] : [point];
  });
}
