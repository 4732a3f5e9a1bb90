// The page that scores trajectories of files, runs and logs: choice, plots over time, table.
import type { Evaluation } from '../../protocol/score_types';
import { formatNumber, kNothing } from '../../store/format';
import type { PlotSpec } from '../../store/plots/plot_specs';
import type { ScoreRow } from '../../store/scoring/score_rows';
import {
  exportScores,
  kScoreFigures,
  offsetTexts,
  scoreAlignments,
  scoreFixFigures,
  scoreRows,
} from '../../store/scoring/score_rows';
import { shortName } from '../../store/scoring/score_desk';
import type { ScoreGroup } from '../../store/scoring/score_specs';
import { scoreSpan, scoreSpecs } from '../../store/scoring/score_specs';
import type { Topic } from '../../store/state';
import type { TextFormat } from '../../store/table_text';
import { kTextFormats } from '../../store/table_text';
import type { Span } from '../../store/time_window';
import { panned, zoomed } from '../../store/time_window';
import { copyText } from '../clipboard';
import { estimateColour } from '../colours';
import { h, rebuild, setText } from '../dom';
import type { PlotActions } from '../plots/plot';
import { Plot } from '../plots/plot';
import { plotFilesMenu } from '../plots/plot_files';
import type { Context, View } from '../view';
import { ScoreChoices } from './score_choices';

const kGroups: readonly { name: ScoreGroup; label: string }[] = [
  { name: 'pose', label: 'Pose' },
  { name: 'errors', label: 'Errors' },
];
const kColumns = 3;

export class ScorePageView implements View {
  readonly root: HTMLElement;
  private readonly choices: ScoreChoices;
  private readonly alignment = h('select', { id: 'score-alignment', 'aria-label': 'Alignment' });
  private readonly tabs = h('span', { class: 'tabs' });
  private readonly grid = h('div', { class: 'plot-grid' });
  private readonly table = h('table', { class: 'errors score-table' });
  private readonly offsets = h('ul', { class: 'score-offsets', 'data-role': 'score-offsets' });
  private readonly copy = h(
    'select',
    { 'aria-label': 'Copy the scores', title: 'Copies the scores of every alignment' },
    h('option', { value: '' }, 'Copy'),
    ...kTextFormats.map((format) => h('option', { value: format }, format)),
  );
  private readonly message = h('div', { class: 'log-message', 'data-role': 'score-message' });
  private group: ScoreGroup = 'errors';
  private plots: Plot[] = [];
  private drawn: { series: Evaluation | null; group: ScoreGroup } = { series: null, group: 'pose' };
  private window_s: Span | null = null;

  constructor(private readonly context: Context) {
    const { scores } = context;
    this.choices = new ScoreChoices(context);
    this.alignment.addEventListener('change', () => {
      void scores.chooseAlignment(this.alignment.value);
    });
    this.copy.addEventListener('change', () => {
      const format = this.copy.value as TextFormat;
      this.copy.value = '';
      void this.copyAs(format);
    });
    const files = plotFilesMenu(
      () => this.shownPlots(),
      (text) => context.notices.error(text),
    );
    const close = h(
      'button',
      { class: 'icon-button', 'aria-label': 'Close', onclick: () => scores.close() },
      '×',
    );
    this.root = h(
      'div',
      { class: 'score-page', role: 'dialog', 'aria-label': 'Score trajectories' },
      h('header', { class: 'log-header' }, h('h2', {}, 'Score trajectories'), close),
      this.choices.root,
      h(
        'div',
        { class: 'score-centre' },
        h(
          'div',
          { class: 'score-tools' },
          this.tabs,
          files,
          'Alignment',
          this.alignment,
          this.copy,
        ),
        h('div', { class: 'score-plots' }, this.grid, this.message),
        h('div', { class: 'score-figures' }, this.table, this.offsets),
      ),
    );
    new ResizeObserver(() => this.drawPlots()).observe(this.grid);
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('theme')) for (const plot of this.plots) plot.repaint();
    if (!changed.has('scoring') && !changed.has('lists')) return;
    const { scorePage } = this.context.store.state;
    if (!scorePage.open) return;
    this.choices.update();
    this.drawTools();
    this.drawPlots();
    this.drawTable(scorePage.scores);
    setText(this.message, this.messageText());
    this.message.hidden = this.message.textContent === '';
    this.message.classList.toggle('failed', scorePage.error !== null);
  }

  private messageText(): string {
    const { error, working, truth, estimates, series } = this.context.store.state.scorePage;
    if (error !== null) return error;
    if (truth === null) return 'Choose the truth: it sets the time base.';
    if (estimates.length === 0) return 'Tick the trajectories to be scored against it.';
    return working && series === null ? 'Scoring' : '';
  }

  private drawTools(): void {
    const { scores, alignment } = this.context.store.state.scorePage;
    const found = scores === null ? [] : scoreAlignments(scores);
    const modes = found.includes(alignment) ? found : [alignment, ...found];
    rebuild(this.alignment, modes.join(' '), () =>
      modes.map((mode) => h('option', { value: mode }, mode)),
    );
    this.alignment.value = alignment;
    this.copy.disabled = scores === null;
    rebuild(this.tabs, this.group, () =>
      kGroups.map(({ name, label }) =>
        h(
          'button',
          {
            class: 'tab',
            'data-score-group': name,
            'aria-pressed': name === this.group ? 'true' : 'false',
            onclick: () => {
              this.group = name;
              this.drawTools();
              this.drawPlots();
            },
          },
          label,
        ),
      ),
    );
  }

  private specs(): PlotSpec[] {
    const { series } = this.context.store.state.scorePage;
    const [mode] = Object.keys(series?.estimates.find((one) => one.series)?.series ?? {});
    return series === null || mode === undefined ? [] : scoreSpecs(series, mode, this.group);
  }

  private shownPlots() {
    const { series } = this.context.store.state.scorePage;
    const specs = this.specs();
    if (series === null || specs.length === 0) return null;
    const span_s = this.window_s ?? scoreSpan(series);
    return { group: `scores-${this.group}`, specs, span_s, columns: kColumns };
  }

  private drawPlots(): void {
    const { series } = this.context.store.state.scorePage;
    const { drawn, group } = this;
    if (drawn.series !== series || drawn.group !== group) {
      if (drawn.series?.truth.name !== series?.truth.name) this.window_s = null;
      this.drawn = { series, group };
      this.build();
    }
    if (series === null) return;
    for (const plot of this.plots) plot.draw(this.window_s ?? scoreSpan(series));
  }

  private build(): void {
    for (const plot of this.plots) plot.destroy();
    const specs = this.specs();
    const moveTo = (t_s: number | null) => {
      for (const plot of this.plots) {
        plot.moveCursor(t_s);
        plot.showCursor(t_s);
      }
    };
    const actions: PlotActions = {
      onSeek: moveTo,
      onHover: moveTo,
      onZoom: (centre_s, factor) =>
        this.move((span_s, whole) => zoomed(span_s, whole, centre_s, factor)),
      onPan: (by_s) => this.move((span_s, whole) => panned(span_s, whole, by_s)),
      onWhole: () => this.move(() => null),
    };
    this.plots = specs.map(
      (spec, i) =>
        new Plot(spec, actions, { timeLabels: i >= specs.length - kColumns, leads: i === 0 }),
    );
    this.grid.style.gridTemplateColumns = `repeat(${kColumns}, minmax(0, 1fr))`;
    this.grid.style.gridTemplateRows = 'repeat(2, minmax(92px, 1fr))';
    this.grid.replaceChildren(...this.plots.map(({ root }) => root));
  }

  /** Shows another part of the time; null = all of it. */
  private move(to: (span_s: Span, whole: Span) => Span | null): void {
    const { series } = this.context.store.state.scorePage;
    if (series === null) return;
    const whole = scoreSpan(series);
    this.window_s = to(this.window_s ?? whole, whole);
    this.drawPlots();
  }

  private drawTable(scores: Evaluation | null): void {
    const rows = scores === null ? [] : scoreRows(scores);
    this.table.hidden = rows.length === 0;
    const offsets = scores === null ? [] : offsetTexts(scores);
    rebuild(this.offsets, JSON.stringify(offsets), () => offsets.map((text) => h('li', {}, text)));
    const figures = [...kScoreFigures, ...(scores === null ? [] : scoreFixFigures(scores))];
    rebuild(this.table, JSON.stringify(rows), () => [
      h(
        'thead',
        {},
        h(
          'tr',
          {},
          h('th', {}, 'Trajectory'),
          h('th', {}, 'Alignment'),
          ...figures.map(({ label, unit }) =>
            h('th', { scope: 'col' }, label, h('span', { class: 'unit' }, ` ${unit}`)),
          ),
        ),
      ),
      h('tbody', {}, ...rows.map((row) => tableRow(row, figures.length))),
    ]);
  }

  private async copyAs(format: TextFormat): Promise<void> {
    const { notices, store } = this.context;
    const { scores } = store.state.scorePage;
    if (scores === null) return;
    if (await copyText(exportScores(scores, format))) notices.info(`Scores copied as ${format}.`);
    else notices.error('The browser does not permit copying.');
  }
}

/** @param figures  number of columns with figures */
function tableRow(row: ScoreRow, figures: number): HTMLElement {
  const { estimate, index, alignment, values, extras, hints, failed } = row;
  const colour = `color:${estimateColour(index)}`;
  const head = h('th', { scope: 'row', title: estimate, style: colour }, shortName(estimate));
  if (failed) {
    return h('tr', {}, head, h('td', { colspan: figures + 1, class: 'bad' }, hints.join(' ')));
  }
  const mark = hints.length === 0 ? null : h('span', { class: 'chip small warn' }, '!');
  return h(
    'tr',
    { 'data-estimate': estimate, 'data-alignment': alignment },
    head,
    h('td', { title: hints.join('\n') }, alignment, mark),
    ...values.map((value, i) =>
      h(
        'td',
        { 'data-figure': kScoreFigures[i]?.key ?? '' },
        value === null ? kNothing : formatNumber(value, kScoreFigures[i]?.digits ?? 3),
      ),
    ),
    ...extras.map(({ text, bad }) => h('td', { class: bad ? 'bad' : '' }, text)),
  );
}
