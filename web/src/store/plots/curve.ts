// A curve over time, and what of it is drawn: few points that look like all of them.
import { lastAtOrBefore } from '../table';
import type { Span } from '../time_window';

export interface Curve {
  /** Ascending. */
  t: ArrayLike<number>;
  /** Seconds of the clock = t * t_scale_s + t_offset_s. */
  t_scale_s: number;
  t_offset_s: number;
  /** As many as times; NaN breaks the curve. */
  values: ArrayLike<number>;
  /** Shown value = value * scale. */
  scale: number;
  /** Values farther apart than this are not joined [s]. */
  longest_gap_s: number;
  /** Whether the values are angles in (-180, 180] deg, not joined where they wrap. */
  wraps: boolean;
}

/** Points to be joined; NaN breaks the line. */
export interface Polyline {
  t_s: number[];
  values: number[];
}

/**
 * The curve in a span of time and up to the next point on each side. Of more than two points per
 * interval, the first, the smallest, the largest and the last remain, which draw the same pixels
 * (Jugel et al., M4: A Visualization-Oriented Time Series Data Aggregation, VLDB 2014).
 * @param intervals  of the span: its pixels
 */
export function decimated(curve: Curve, span_s: Span, intervals: number): Polyline {
  const { t, t_scale_s, t_offset_s, values, scale } = curve;
  const toRow = (t_s: number) => lastAtOrBefore(t, (t_s - t_offset_s) / t_scale_s);
  const first = Math.max(0, toRow(span_s[0]));
  const last = Math.min(t.length - 1, toRow(span_s[1]) + 1);
  const line = new Thinned(curve, last - first > 2 * intervals);
  const perInterval = intervals / Math.max(1e-9, span_s[1] - span_s[0]);
  for (let row = first; row <= last; row += 1) {
    const t_s = (t[row] ?? NaN) * t_scale_s + t_offset_s;
    line.add(t_s, (values[row] ?? NaN) * scale, Math.floor((t_s - span_s[0]) * perInterval));
  }
  return line.end();
}

class Thinned {
  private readonly line: Polyline = { t_s: [], values: [] };
  private before_s = NaN;
  private before = NaN;
  private interval = NaN;
  /** Of the interval, in the order of time: first, the two extremes, last. */
  private points: { t_s: number; value: number }[] = [];

  constructor(
    private readonly curve: Curve,
    private readonly thin: boolean,
  ) {}

  add(t_s: number, value: number, interval: number): void {
    const { longest_gap_s, wraps } = this.curve;
    const gap = t_s - this.before_s > longest_gap_s;
    const wrapped = wraps && Math.abs(value - this.before) > 180;
    if (Number.isNaN(value) || gap || wrapped) this.break((t_s + this.before_s) / 2);
    this.before_s = t_s;
    this.before = value;
    if (Number.isNaN(value)) return;
    if (!this.thin) {
      this.push(t_s, value);
      return;
    }
    if (interval !== this.interval) this.flush();
    this.interval = interval;
    this.keep({ t_s, value });
  }

  end(): Polyline {
    this.flush();
    return this.line;
  }

  private keep(point: { t_s: number; value: number }): void {
    const { points } = this;
    points.push(point);
    if (points.length <= 4) return;
    // Of the three between the first and the last, the smallest and the largest stay.
    const middle = points.slice(1, 4).sort((a, b) => a.value - b.value)[1];
    points.splice(
      points.findIndex((one) => one === middle),
      1,
    );
  }

  private flush(): void {
    for (const { t_s, value } of this.points) this.push(t_s, value);
    this.points = [];
  }

  private break(t_s: number): void {
    this.flush();
    const { values } = this.line;
    if (values.length > 0 && !Number.isNaN(values.at(-1))) this.push(t_s, NaN);
  }

  private push(t_s: number, value: number): void {
    this.line.t_s.push(t_s);
    this.line.values.push(value);
  }
}

/** Row of the last value at or before a time of the clock; -1 if none, or only one before a gap. */
export function rowAt({ t, t_scale_s, t_offset_s, longest_gap_s }: Curve, t_s: number): number {
  const row = lastAtOrBefore(t, (t_s - t_offset_s + kRounding_s) / t_scale_s);
  if (row < 0) return -1;
  const age_s = t_s - ((t[row] ?? NaN) * t_scale_s + t_offset_s);
  return age_s > longest_gap_s ? -1 : row;
}

/** Because times are rounded when they are converted. */
const kRounding_s = 1e-9;

/** The shown value at a time of the clock; NaN if there is none. */
export function valueAt(curve: Curve, t_s: number): number {
  const row = rowAt(curve, t_s);
  return row < 0 ? NaN : (curve.values[row] ?? NaN) * curve.scale;
}
