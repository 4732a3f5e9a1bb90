// The part of the flight that the plots show: all of it, or the part zoomed to.

const kNarrowest_s = 0.5;

export type Span = readonly [number, number];

/** Zooms about a fixed time; null = the whole flight. */
export function zoomed(span: Span, whole: Span, centre_s: number, factor: number): Span | null {
  const low = centre_s - (centre_s - span[0]) * factor;
  const high = centre_s + (span[1] - centre_s) * factor;
  if (high - low >= whole[1] - whole[0]) return null;
  if (high - low < kNarrowest_s) return span;
  return shiftedInto([low, high], whole);
}

/** The window moved so that it contains the cursor. */
export function following(span: Span, whole: Span, cursor_s: number): Span {
  if (cursor_s >= span[0] && cursor_s <= span[1]) return span;
  const width = span[1] - span[0];
  const low = cursor_s > span[1] ? cursor_s - 0.1 * width : cursor_s - 0.9 * width;
  return shiftedInto([low, low + width], whole);
}

function shiftedInto([low, high]: Span, whole: Span): Span {
  const shift = Math.max(0, whole[0] - low) - Math.max(0, high - whole[1]);
  return [low + shift, high + shift];
}
