// The part of the flight that the plots show: all of it, or the part zoomed to.

const kNarrowest_s = 0.5;
/** A longer step of the clock, of a second of playback, is a jump of the viewer. */
const kJump_s = 1;

export type Span = readonly [number, number];

/** The part zoomed to. */
export interface PlotWindow {
  span_s: Span;
  /** The clock's time that an address names: until the clock gets there, the window stays. */
  waits_ns: number | null;
}

/** Zooms about a fixed time; null = the whole flight. */
export function zoomed(span: Span, whole: Span, centre_s: number, factor: number): Span | null {
  const low = centre_s - (centre_s - span[0]) * factor;
  const high = centre_s + (span[1] - centre_s) * factor;
  if (high - low >= whole[1] - whole[0]) return null;
  if (high - low < kNarrowest_s) return span;
  return shiftedInto([low, high], whole);
}

/** The window moved to later times, or to earlier ones, as far as the flight goes. */
export function panned([low, high]: Span, whole: Span, by_s: number): Span {
  return shiftedInto([low + by_s, high + by_s], whole);
}

/** The window moved so that it contains the cursor. */
export function following(span: Span, whole: Span, cursor_s: number): Span {
  if (contains(span, cursor_s)) return span;
  const width = span[1] - span[0];
  const low = cursor_s > span[1] ? cursor_s - 0.1 * width : cursor_s - 0.9 * width;
  return shiftedInto([low, low + width], whole);
}

/**
 * Whether the window follows the cursor: not if it was moved away from it, until the clock jumps.
 * @param speed  of playback
 */
export function follows(span: Span, before_s: number, cursor_s: number, speed: number): boolean {
  if (before_s === cursor_s) return false;
  if (contains(span, before_s)) return true;
  return Math.abs(cursor_s - before_s) > kJump_s * Math.max(1, Math.abs(speed));
}

function contains([low, high]: Span, t_s: number): boolean {
  return t_s >= low && t_s <= high;
}

function shiftedInto([low, high]: Span, whole: Span): Span {
  const shift = Math.max(0, whole[0] - low) - Math.max(0, high - whole[1]);
  return [low + shift, high + shift];
}
