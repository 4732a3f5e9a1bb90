// The part of the flight that the plots show: all of it, or the part zoomed to.

const kNarrowest_s = 0.5;

export type Span = readonly [number, number];

/** The part zoomed to. It contains the clock's time once that has moved on from `chosen_ns`. */
export interface PlotWindow {
  span_s: Span;
  /** The clock's time when it was zoomed to; that of an address, until the clock gets there. */
  chosen_ns: number | null;
  /** Whether the clock has been there. */
  reached: boolean;
}

/** The window at the clock's time; the same object if nothing changes. */
export function windowAt(
  window: PlotWindow,
  whole: Span,
  clock: { t_ns: number; playing: boolean },
): PlotWindow {
  const there = clock.t_ns === window.chosen_ns;
  if (there) return window.reached ? window : { ...window, reached: true };
  if (!window.reached && window.chosen_ns !== null && !clock.playing) return window;
  const span_s = following(window.span_s, whole, clock.t_ns / 1e9);
  const moved = span_s !== window.span_s || window.chosen_ns !== null;
  return moved ? { span_s, chosen_ns: null, reached: true } : window;
}

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
