// A curve over time, and what of it is drawn: few points that look like all of them.
import { lastAtOrBefore } from '../table';
import type { Span } from '../playback/time_window';

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
 * (Jugel et al., M4: A Visualization-Oriented Time Series Data Aggregation, VLDB 2014). The intervals
 * begin at fixed times, so that a curve that is moved keeps its shape.
 * @param intervals  of the span: its pixels
 */
export function decimated(curve: Curve, span_s: Span, intervals: number): Polyline {
  const { t, t_scale_s, t_offset_s, values, scale, longest_gap_s, wraps } = curve;
  const toRow = (t_s: number) => lastAtOrBefore(t, (t_s - t_offset_s) / t_scale_s);
  const first = Math.max(0, toRow(span_s[0]));
  const last = Math.min(t.length - 1, toRow(span_s[1]) + 1);
  // Without thinning every point has an interval of its own.
  const thin = last - first > 2 * intervals;
  const perInterval = intervals / Math.max(1e-9, span_s[1] - span_s[0]);
  const line: Polyline = { t_s: [], values: [] };
  const group = new Interval(line);
  let before_s = NaN;
  let before = NaN;
  for (let row = first; row <= last; row += 1) {
    const t_s = (t[row] ?? NaN) * t_scale_s + t_offset_s;
    const value = (values[row] ?? NaN) * scale;
    const broken =
      value !== value ||
      t_s - before_s > longest_gap_s ||
      (wraps && Math.abs(value - before) > 180);
    if (broken) group.break((t_s + before_s) / 2);
    before_s = t_s;
    before = value;
    if (value === value) group.add(t_s, value, thin ? Math.floor(t_s * perInterval) : row);
  }
  group.end();
  return line;
}

/** The points of one interval of which at most four are drawn. Called for every value of long series. */
class Interval {
  private index = NaN;
  private count = 0;
  private first_s = 0;
  private first = 0;
  private least_s = 0;
  private least = 0;
  private most_s = 0;
  private most = 0;
  private last_s = 0;
  private last = 0;

  constructor(private readonly line: Polyline) {}

  add(t_s: number, value: number, index: number): void {
    if (index !== this.index) this.end();
    if (this.count === 0) {
      this.index = index;
      this.first_s = this.least_s = this.most_s = t_s;
      this.first = this.least = this.most = value;
    } else if (value < this.least) {
      this.least = value;
      this.least_s = t_s;
    } else if (value > this.most) {
      this.most = value;
      this.most_s = t_s;
    }
    this.last = value;
    this.last_s = t_s;
    this.count += 1;
  }

  break(t_s: number): void {
    this.end();
    const { values } = this.line;
    if (values.length > 0 && !Number.isNaN(values.at(-1))) this.push(t_s, NaN);
  }

  /** Draws the points kept, in the order of time. */
  end(): void {
    if (this.count === 0) return;
    this.push(this.first_s, this.first);
    const rising = this.least_s < this.most_s;
    this.pushInside(rising ? this.least_s : this.most_s, rising ? this.least : this.most);
    this.pushInside(rising ? this.most_s : this.least_s, rising ? this.most : this.least);
    if (this.count > 1) this.push(this.last_s, this.last);
    this.count = 0;
  }

  private pushInside(t_s: number, value: number): void {
    if (t_s > this.first_s && t_s < this.last_s) this.push(t_s, value);
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
