// The page that scores trajectories of files, runs and logs: choice, plots over time, table.
import type { Evaluation } from '../../protocol/score_types';
import type { ErrorColumn } from '../../store/errors/error_figures';
import type { ScoreRow } from '../../store/scoring/score_rows';
import {
  exportScores,
  offsetTexts,
  scoreAlignments,
  scoreColumns,
  scoreRows,
} from '../../store/scoring/score_rows';
import { shortName } from '../../store/scoring/score_desk';
import type { Topic } from '../../store/state';
import type { TextFormat } from '../../store/table_text';
import { kTextFormats } from '../../store/table_text';
import { copyText } from '../clipboard';
import { estimateColour } from '../colours';
import { h, rebuild, setText } from '../dom';
import type { Context, View } from '../view';
import { ScoreChoices } from './score_choices';
import { ScorePlots } from './score_plots';

export class ScorePageView implements View {
  readonly root: HTMLElement;
  private readonly choices: ScoreChoices;
  private readonly alignment = h('select', { id: 'score-alignment', 'aria-label': 'Alignment' });
  private readonly plots: ScorePlots;
  private readonly table = h('table', { class: 'errors score-table' });
  private readonly offsets = h('ul', { class: 'score-offsets', 'data-role': 'score-offsets' });
  private readonly copy = h(
    'select',
    { 'aria-label': 'Copy the scores', title: 'Copies the scores of every alignment' },
    h('option', { value: '' }, 'Copy'),
    ...kTextFormats.map((format) => h('option', { value: format }, format)),
  );
  private readonly message = h('div', { class: 'log-message', 'data-role': 'score-message' });

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
    this.plots = new ScorePlots(context);
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
          this.plots.tabs,
          this.plots.axis,
          this.plots.files,
          'Alignment',
          this.alignment,
          this.copy,
        ),
        this.message,
        this.plots.root,
        h('div', { class: 'score-figures' }, this.offsets, this.table),
      ),
    );
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('theme')) this.plots.repaint();
    if (!changed.has('scoring') && !changed.has('lists')) return;
    const { scorePage } = this.context.store.state;
    if (!scorePage.open) return;
    this.choices.update();
    this.drawTools();
    this.plots.draw();
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
    if (series === null) return working ? 'Scoring' : '';
    return this.plots.emptyText();
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
  }

  private drawTable(scores: Evaluation | null): void {
    const rows = scores === null ? [] : scoreRows(scores);
    this.table.hidden = rows.length === 0;
    const offsets = scores === null ? [] : offsetTexts(scores);
    this.offsets.hidden = offsets.length === 0;
    rebuild(this.offsets, JSON.stringify(offsets), () => offsets.map((text) => h('li', {}, text)));
    const columns = scores === null ? [] : scoreColumns(scores);
    rebuild(this.table, JSON.stringify(rows), () => [
      h(
        'thead',
        {},
        h(
          'tr',
          {},
          h('th', {}, 'Trajectory'),
          h('th', {}, 'Alignment'),
          ...columns.map(({ label, unit, hint }) =>
            h('th', { scope: 'col', title: hint }, label, h('span', { class: 'unit' }, ` ${unit}`)),
          ),
        ),
      ),
      h('tbody', {}, ...rows.map((row) => tableRow(row, columns))),
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

function tableRow(row: ScoreRow, columns: readonly ErrorColumn[]): HTMLElement {
  const { estimate, index, alignment, cells, hints, failed } = row;
  const colour = `color:${estimateColour(index)}`;
  const head = h('th', { scope: 'row', title: estimate, style: colour }, shortName(estimate));
  if (failed) {
    return h(
      'tr',
      {},
      head,
      h('td', { colspan: columns.length + 1, class: 'bad' }, hints.join(' ')),
    );
  }
  const mark = hints.length === 0 ? null : h('span', { class: 'chip small warn' }, '!');
  return h(
    'tr',
    { 'data-estimate': estimate, 'data-alignment': alignment },
    head,
    h('td', { title: hints.join('\n') }, alignment, mark),
    ...cells.map(({ text, bad }, i) =>
      h('td', { class: bad ? 'bad' : '', 'data-figure': columns[i]?.key ?? '' }, text),
    ),
  );
}
