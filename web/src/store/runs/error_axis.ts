// The axis of a plot of errors: linear, or logarithmic where they differ by more than a factor 50.
import { ticks } from '../plots/path_frame';

const kLinearRatio = 50;
const kMostTicks = 6;

export interface ErrorAxis {
  logarithmic: boolean;
  low: number;
  high: number;
}

/** The axis for positive errors; for none, [0, 1]. */
export function errorAxis(errors: readonly number[]): ErrorAxis {
  const most = errors.reduce((a, b) => Math.max(a, b), 0);
  if (most <= 0) return { logarithmic: false, low: 0, high: 1 };
  const least = errors.filter((error) => error > 0).reduce((a, b) => Math.min(a, b), most);
  if (most <= kLinearRatio * least) return { logarithmic: false, low: 0, high: 1.05 * most };
  const low = 10 ** Math.floor(Math.log10(least));
  return { logarithmic: true, low, high: 10 ** Math.ceil(Math.log10(most)) };
}

/** Place of an error on the axis, in [0, 1]. */
export function placeOn({ logarithmic, low, high }: ErrorAxis, error: number): number {
  const place = logarithmic
    ? Math.log(Math.max(error, low) / low) / Math.log(high / low)
    : (error - low) / (high - low);
  return Math.min(1, Math.max(0, place));
}

/** @param room  for so many numbers */
export function axisTicks({ logarithmic, low, high }: ErrorAxis, room: number): number[] {
  const most = Math.min(kMostTicks, Math.max(1, Math.floor(room)));
  if (!logarithmic) return ticks(low, high, most);
  const decades = Math.round(Math.log10(high / low));
  const step = Math.ceil(decades / most);
  return Array.from({ length: Math.floor(decades / step) + 1 }, (_, i) => low * 10 ** (i * step));
}

/** Number of errors in each of `bins` equal parts of the axis. */
export function histogram(axis: ErrorAxis, errors: readonly number[], bins: number): number[] {
  const counts = new Array<number>(bins).fill(0);
  for (const error of errors) {
    const bin = Math.min(bins - 1, Math.floor(placeOn(axis, error) * bins));
    counts[bin] = (counts[bin] ?? 0) + 1;
  }
  return counts;
}
