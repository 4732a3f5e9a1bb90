// The part of the clock's time that all plots show together: they are zoomed and moved as one.
import type { State, Store } from '../state';
import { clockSpan_ns } from '../state';
import type { Span } from '../time_window';
import { following, follows, panned, zoomed } from '../time_window';

export class PlotTime {
  /** Of the runs that it was chosen for; others are shown whole. */
  private chosen: { runs: string; span_s: Span } | null = null;
  private clock_s = NaN;

  constructor(private readonly store: Store) {}

  /** All of the flights. */
  get whole_s(): Span {
    const [begin_ns, end_ns] = clockSpan_ns(this.store.state);
    return [begin_ns / 1e9, end_ns / 1e9];
  }

  /** The part zoomed to; null = everything. */
  get part_s(): Span | null {
    return this.chosen?.runs === runsOf(this.store.state) ? this.chosen.span_s : null;
  }

  get shown_s(): Span {
    return this.part_s ?? this.whole_s;
  }

  /** @param factor  below 1 shows less */
  zoom(centre_s: number, factor: number): void {
    this.show(zoomed(this.shown_s, this.whole_s, centre_s, factor));
  }

  /** Zooms about the clock's time if it is shown, else about the middle. */
  zoomAtClock(factor: number): void {
    const [low, high] = this.shown_s;
    const clock_s = (this.store.state.clock?.t_ns ?? NaN) / 1e9;
    this.zoom(clock_s >= low && clock_s <= high ? clock_s : (low + high) / 2, factor);
  }

  pan(by_s: number): void {
    if (this.part_s !== null) this.show(panned(this.part_s, this.whole_s, by_s));
  }

  showWhole(): void {
    this.show(null);
  }

  /** Keeps the clock's time in the part shown, unless the viewer has moved away from it. */
  follow(): void {
    const { clock } = this.store.state;
    if (clock === null) return;
    const before_s = this.clock_s;
    this.clock_s = clock.t_ns / 1e9;
    const part_s = this.part_s;
    if (part_s === null || !follows(part_s, before_s, this.clock_s, clock.speed)) return;
    this.show(following(part_s, this.whole_s, this.clock_s));
  }

  private show(span_s: Span | null): void {
    const before = this.part_s;
    if (before?.[0] === span_s?.[0] && before?.[1] === span_s?.[1]) return;
    this.chosen = span_s === null ? null : { runs: runsOf(this.store.state), span_s };
    this.store.change('plotTime');
  }
}

function runsOf({ watched }: State): string {
  return watched.map(({ id }) => id).join(' ');
}
