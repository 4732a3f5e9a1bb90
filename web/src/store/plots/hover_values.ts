// The values of many curves at one time, as a list next to the mouse.

export interface HoverRow {
  /** Of the curve. */
  index: number;
  value: number;
}

export interface HoverRows {
  /** The greatest value first, as the curves lie above each other. */
  rows: HoverRow[];
  /** The curve nearest to the mouse; -1 without values. */
  nearest: number;
  /** Number of curves with a value that are left out: those farthest from the mouse. */
  more: number;
}

/**
 * @param values  of the curves; null or NaN = none
 * @param pointed  value at the mouse
 * @param most  number of rows
 */
export function hoverRows(
  values: readonly (number | null)[],
  pointed: number,
  most: number,
): HoverRows {
  const known = values.flatMap((value, index) =>
    value === null || Number.isNaN(value) ? [] : [{ index, value }],
  );
  const off = ({ value }: HoverRow) => Math.abs(value - pointed);
  known.sort((a, b) => off(a) - off(b));
  const rows = known.slice(0, most);
  rows.sort((a, b) => b.value - a.value || a.index - b.index);
  return { rows, nearest: known[0]?.index ?? -1, more: known.length - rows.length };
}
