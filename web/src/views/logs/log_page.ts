// The page of flight logs over the dashboard: list, map, plots, contents, and the flight's form.
import type { Track } from '../../store/logs/log_track';
import { trackOf } from '../../store/logs/log_track';
import type { Outline } from '../../store/logs/log_worlds';
import { movedTrack, outlineOf, shareOutside } from '../../store/logs/log_worlds';
import type { Topic } from '../../store/state';
import type { LogSeries, WorldExtent } from '../../protocol/log_types';
import type { LogFlight } from '../../store/logs/log_flight';
import { h, rebuild, setAttribute, setText } from '../dom';
import type { Context, View } from '../view';
import { LogCurves } from './log_curves';
import { LogForm } from './log_form';
import { LogListView } from './log_list';
import { LogMap } from './log_map';
import { LogResidualsView } from './log_residuals';
import { LogStreams } from './log_streams';

export class LogPageView implements View {
  readonly root: HTMLElement;
  private readonly list: LogListView;
  private readonly map = new LogMap((t_s) => this.map.moveCursor(t_s));
  private readonly curves: LogCurves;
  private readonly residuals: LogResidualsView;
  private readonly tabs = h('div', { class: 'log-tabs' });
  private readonly streams = new LogStreams();
  private readonly form: LogForm;
  private readonly message = h('div', { class: 'log-message', 'data-role': 'log-message' });
  private series: LogSeries | null = null;
  private track: Track | null = null;
  /** What the map shows, and what it was made of. */
  private shown: { key: unknown[]; track: Track | null; outlines: Outline[]; note: string } = {
    key: [],
    track: null,
    outlines: [],
    note: '',
  };

  constructor(private readonly context: Context) {
    this.list = new LogListView(context);
    this.form = new LogForm(context);
    const onHover = (t_s: number | null) => this.map.moveCursor(t_s);
    const onSlice = (from_s: number, to_s: number) =>
      context.logs.set({ from_s: round(from_s), to_s: round(to_s) });
    this.curves = new LogCurves(onHover, onSlice);
    this.residuals = new LogResidualsView({
      onHover,
      onSlice,
      onCancel: () => context.smoothing.cancel(),
      onAgain: () => context.smoothing.again(),
    });
    const close = h(
      'button',
      { class: 'icon-button', 'aria-label': 'Close', onclick: () => context.logs.close() },
      '×',
    );
    const all = h(
      'button',
      {
        class: 'secondary log-whole',
        'data-role': 'log-whole',
        onclick: () => context.logs.set({ from_s: null, to_s: null }),
      },
      'Whole flight',
    );
    this.root = h(
      'div',
      { class: 'log-page', role: 'dialog', 'aria-label': 'Flight logs' },
      h('header', { class: 'log-header' }, h('h2', {}, 'Flight logs'), close),
      this.list.root,
      h(
        'div',
        { class: 'log-centre' },
        this.map.root,
        h('div', { class: 'log-plots' }, this.tabs, this.curves.root, this.residuals.root),
        this.message,
      ),
      h('div', { class: 'log-side' }, this.streams.root, all, this.form.root),
    );
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('theme')) this.repaint();
    const relevant = changed.has('logs') || changed.has('lists') || changed.has('connection');
    if (!relevant) return;
    const { logPage, mayChange } = this.context.store.state;
    this.context.smoothing.refresh();
    if (!logPage.open) return;
    void this.context.worlds.refresh();
    this.drawTabs();
    const { info, series, flight, error, chosen } = logPage;
    setAttribute(this.map.root, 'data-source', series?.position_source ?? null);
    this.list.update();
    this.streams.show(info);
    this.form.update();
    if (series !== this.series) {
      this.series = series;
      this.track = series === null ? null : trackOf(series);
    }
    this.showMap();
    this.curves.show(info, series);
    const slice = sliceOf(flight);
    this.map.showSlice(slice);
    this.curves.showSlice(slice);
    this.curves.root.hidden = logPage.smoothing.open;
    this.residuals.root.hidden = !logPage.smoothing.open;
    this.residuals.show(logPage.smoothing, info, series);
    this.residuals.showSlice(slice);
    const reading = logPage.reading ? 'Reading the log' : '';
    const choose = mayChange ? 'Choose a log, or upload one.' : 'Choose a log.';
    setText(this.message, error ?? (chosen === null ? choose : reading));
    this.message.classList.toggle('failed', error !== null);
    this.message.hidden = this.message.textContent === '';
  }

  private repaint(): void {
    this.map.repaint();
    this.curves.repaint();
    this.residuals.repaint();
  }

  /** The flight at its own place, or moved to the chosen world. */
  private showMap(): void {
    const { flight, worlds } = this.context.store.state.logPage;
    const { track } = this;
    const chosen = worlds.get(flight.scenario) ?? null;
    const key = [track, flight.scenario, flight.rebase, flight.turn_deg, worlds.size, chosen];
    key.push(flight.from_s, flight.to_s);
    if (key.some((part, i) => part !== this.shown.key[i])) {
      this.shown = { key, ...this.placed(track) };
    }
    this.map.show(this.shown.track, this.shown.outlines, this.shown.note);
  }

  private placed(track: Track | null): { track: Track | null; outlines: Outline[]; note: string } {
    const { flight, worlds } = this.context.store.state.logPage;
    const chosen = worlds.get(flight.scenario) ?? null;
    if (track === null || track.origin === null) return { track, outlines: [], note: '' };
    const slice = sliceOf(flight);
    const turn_deg = Number(flight.turn_deg);
    const moves = flight.rebase && chosen !== null;
    const shown = moves
      ? movedTrack(track, chosen, Number.isFinite(turn_deg) ? turn_deg : 0, slice)
      : track;
    const origin = shown.origin ?? track.origin;
    const known = [...worlds.values()].filter((world) => world !== null);
    const others = known.filter(
      (world, i) => world.name !== chosen?.name && known.findIndex(same(world)) === i,
    );
    const outlines = others.map((world) => outlineOf(world, origin, false));
    if (chosen === null) return { track: shown, outlines, note: '' };
    const own = outlineOf(chosen, origin, true);
    outlines.push(own);
    const outside = shareOutside(shown, own, slice);
    const where = moves ? `Moved to ${chosen.name}` : `At its own place, over ${chosen.name}`;
    if (outside === 0) return { track: shown, outlines, note: where };
    const part = outside === 1 ? 'all' : `${Math.max(1, Math.round(100 * outside))} %`;
    const note = `${moves ? where : 'At its own place'}: ${part} outside of ${chosen.name}`;
    return { track: shown, outlines, note };
  }

  private drawTabs(): void {
    const { smoothing } = this.context.store.state.logPage;
    const tab = (text: string, hint: string, open: boolean) =>
      h(
        'button',
        {
          class: 'tab',
          type: 'button',
          title: hint,
          'data-tab': open ? 'residuals' : 'flight',
          'aria-pressed': smoothing.open === open ? 'true' : 'false',
          onclick: () => this.context.smoothing.show(open),
        },
        text,
      );
    rebuild(this.tabs, String(smoothing.open), () => [
      tab('Flight', 'Height, speed and attitude', false),
      tab('Smoothing', 'Residuals: logged samples minus the smooth motion', true),
    ]);
  }
}

function same(world: WorldExtent): (other: WorldExtent) => boolean {
  const text = JSON.stringify(world.outline);
  return (other) => JSON.stringify(other.outline) === text;
}

function sliceOf({ from_s, to_s }: LogFlight): readonly [number, number] | null {
  return from_s === null && to_s === null ? null : [from_s ?? -Infinity, to_s ?? Infinity];
}

function round(value: number): number {
  return Math.round(value * 100) / 100;
}
