// The page of flight logs over the dashboard: list, map, plots, contents, and the flight's form.
import type { Track } from '../../store/logs/log_track';
import { trackOf } from '../../store/logs/log_track';
import type { Topic } from '../../store/state';
import type { LogSeries } from '../../protocol/log_types';
import { h, setAttribute, setText } from '../dom';
import type { Context, View } from '../view';
import { LogCurves } from './log_curves';
import { LogForm } from './log_form';
import { LogListView } from './log_list';
import { LogMap } from './log_map';
import { LogStreams } from './log_streams';

export class LogPageView implements View {
  readonly root: HTMLElement;
  private readonly list: LogListView;
  private readonly map = new LogMap((t_s) => this.map.moveCursor(t_s));
  private readonly curves: LogCurves;
  private readonly streams = new LogStreams();
  private readonly form: LogForm;
  private readonly message = h('div', { class: 'log-message', 'data-role': 'log-message' });
  private series: LogSeries | null = null;
  private track: Track | null = null;

  constructor(private readonly context: Context) {
    this.list = new LogListView(context);
    this.form = new LogForm(context);
    this.curves = new LogCurves(
      (t_s) => this.map.moveCursor(t_s),
      (from_s, to_s) => context.logs.set({ from_s: round(from_s), to_s: round(to_s) }),
    );
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
      { class: 'overlay log-overlay', hidden: true, 'data-panel': 'logs' },
      h(
        'div',
        { class: 'log-page', role: 'dialog', 'aria-label': 'Flight logs' },
        h('header', { class: 'log-header' }, h('h2', {}, 'Flight logs'), close),
        this.list.root,
        h('div', { class: 'log-centre' }, this.map.root, this.curves.root, this.message),
        h('div', { class: 'log-side' }, this.streams.root, all, this.form.root),
      ),
    );
    this.acceptDrops();
  }

  update(changed: ReadonlySet<Topic>): void {
    const relevant = changed.has('logs') || changed.has('lists') || changed.has('connection');
    if (!relevant) return;
    const { logPage } = this.context.store.state;
    this.root.hidden = !logPage.open;
    if (!logPage.open) return;
    const { info, series, flight, error, chosen } = logPage;
    setAttribute(this.map.root, 'data-source', series?.position_source ?? null);
    this.list.update();
    this.streams.show(info);
    this.form.update();
    if (series !== this.series) {
      this.series = series;
      this.track = series === null ? null : trackOf(series);
    }
    this.map.show(this.track);
    this.curves.show(info, series);
    const slice =
      flight.from_s === null && flight.to_s === null
        ? null
        : ([flight.from_s ?? -Infinity, flight.to_s ?? Infinity] as const);
    this.map.showSlice(slice);
    this.curves.showSlice(slice);
    const reading = logPage.reading ? 'Reading the log' : '';
    setText(this.message, error ?? (chosen === null ? 'Choose a log, or upload one.' : reading));
    this.message.classList.toggle('failed', error !== null);
    this.message.hidden = this.message.textContent === '';
  }

  /** A file dropped anywhere opens the page and is uploaded. */
  private acceptDrops(): void {
    const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') === true;
    document.addEventListener('dragover', (event) => {
      if (hasFiles(event)) event.preventDefault();
    });
    document.addEventListener('drop', (event) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      const file = event.dataTransfer?.files[0];
      if (file === undefined) return;
      void this.context.logs.open().then(() => this.context.logs.send(file));
    });
  }
}

function round(value: number): number {
  return Math.round(value * 100) / 100;
}
