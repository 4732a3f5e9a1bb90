// The drawn part of a curve. While it is moved, what was made of the values is kept.
import { lastAtOrBefore } from '../table';
import type { Span } from '../playback/time_window';
import type { Curve, Polyline } from './curve';
import { decimated } from './curve';

/** Made on each side beyond the span, in widths of it. */
const kMargin = 1;
/** Widths that differ by less are the same, moved. */
const kRounding = 1e-6;

interface Made {
  of: Curve;
  storage: unknown;
  wide_s: Span;
  width_s: number;
  intervals: number;
  line: Polyline;
}

export class CurveWindow {
  private made: Made | null = null;

  /** As `decimated`, in a fraction of the time where the last span was near. */
  at(curve: Curve, span_s: Span, intervals: number): Polyline {
    const width_s = span_s[1] - span_s[0];
    if (this.made === null || !serves(this.made, curve, span_s, intervals)) {
      const margin_s = kMargin * width_s;
      const wide_s: Span = [span_s[0] - margin_s, span_s[1] + margin_s];
      const line = decimated(curve, wide_s, intervals * (1 + 2 * kMargin));
      this.made = { of: curve, storage: storageOf(curve), wide_s, width_s, intervals, line };
    }
    const { t_s, values } = this.made.line;
    const first = Math.max(0, lastAtOrBefore(t_s, span_s[0]));
    const end = lastAtOrBefore(t_s, span_s[1]) + 2;
    return { t_s: t_s.slice(first, end), values: values.slice(first, end) };
  }
}

function serves(made: Made, curve: Curve, span_s: Span, intervals: number): boolean {
  const { of, storage, wide_s, width_s } = made;
  return (
    storage === storageOf(curve) &&
    of.values.length === curve.values.length &&
    of.t_offset_s === curve.t_offset_s &&
    of.scale === curve.scale &&
    made.intervals === intervals &&
    Math.abs(span_s[1] - span_s[0] - width_s) <= kRounding * width_s &&
    span_s[0] >= wide_s[0] &&
    span_s[1] <= wide_s[1]
  );
}

/** Values that are only appended stay in one buffer, of which curves have views. */
function storageOf({ values }: Curve): unknown {
  return ArrayBuffer.isView(values) ? values.buffer : values;
}
