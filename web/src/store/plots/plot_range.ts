// Range of a plot's axis.

/**
 * The data's range plus a margin of 6 %, at least `least` wide, so that noise does not fill the
 * plot.
 */
export function paddedRange(low: number, high: number, least: number): [number, number] {
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [-least / 2, least / 2];
  const middle = (low + high) / 2;
  const half = Math.max((high - low) * 0.56, least / 2);
  return [middle - half, middle + half];
}
