// The part of the clock's time that all plots show together: they are zoomed and moved as one.
import type { Store } from '../state';
import { clockSpan_ns } from '../state';
import type { Span } from '../playback/time_window';
import { following, follows, panned, zoomed } from '../playback/time_window';

export class PlotTime {
  private clock_s = NaN;

  constructor(private readonly store: Store) {}

  /** All of the flights. */
  get whole_s(): Span {
    const [begin_ns, end_ns] = clockSpan_ns(this.store.state);
    return [begin_ns / 1e9, end_ns / 1e9];
  }

  /** The part zoomed to; null = everything. */
  get part_s(): Span | null {
    return this.store.state.plotWindow?.span_s ?? null;
  }

  /** The same part by the time of the main run. */
  get partOfRun_s(): Span | null {
    const { part_s } = this;
    const offset_s = this.store.state.offset_ns / 1e9;
    return part_s === null ? null : [part_s[0] - offset_s, part_s[1] - offset_s];
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
    const { clock, plotWindow } = this.store.state;
    if (clock === null) return;
    const before_s = this.clock_s;
    this.clock_s = clock.t_ns / 1e9;
    if (plotWindow === null) return;
    const { span_s, waits_ns } = plotWindow;
    if (waits_ns === null) {
      if (!follows(span_s, before_s, this.clock_s, clock.speed)) return;
    } else if (clock.t_ns === waits_ns) {
      this.store.state.plotWindow = { span_s, waits_ns: null };
      return;
    } else if (!clock.playing) return;
    this.show(following(span_s, this.whole_s, this.clock_s));
  }

  private show(span_s: Span | null): void {
    const { state } = this.store;
    const before = state.plotWindow;
    state.plotWindow = span_s === null ? null : { span_s, waits_ns: null };
    const [low, high] = before?.span_s ?? [];
    if (low !== span_s?.[0] || high !== span_s?.[1]) this.store.change('plotTime');
  }
}
