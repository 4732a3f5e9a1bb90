// The page of sweeps: their cells as matrices that fill while they fly, each cell with its flights.
import type { SweepEntry, SweepRow, SweepState } from '../../protocol/sweep_types';
import { formatPercent } from '../../store/format';
import type { Topic } from '../../store/state';
import type { Matrices, Matrix, MatrixCell, SweepFigure } from '../../store/sweeps/sweep_matrix';
import {
  differenceText,
  kSweepFigures,
  matricesOf,
  outcomesText,
  rowsOfCell,
  spreadText,
  valueText,
} from '../../store/sweeps/sweep_matrix';
import { viewerNote } from '../access';
import { h, rebuild, setAttribute, setText, setTextOf } from '../dom';
import { KeyedList } from '../keyed_list';
import type { Context, View } from '../view';
import { labelled, select } from './sweep_controls';
import { EnvelopeView } from './envelope_view';
import { SweepFormView } from './sweep_form_view';
import { sweepDetail, SweepHead } from './sweep_head';
import { SweepResultsView } from './sweep_results_view';

export class SweepPageView implements View {
  readonly root: HTMLElement;
  private readonly list = h('ul', { class: 'log-rows', 'aria-label': 'Sweeps' });
  private readonly drawn = new KeyedList(this.list);
  private readonly add = h(
    'button',
    { class: 'primary', 'data-role': 'new-sweep', 'data-changes': true },
    'New sweep',
  );
  private readonly head: SweepHead;
  private readonly form: SweepFormView;
  private readonly tools = h('div', { class: 'sweep-tools' });
  private readonly matrices = h('div', { class: 'sweep-matrices' });
  private readonly flights = h('section', { class: 'sweep-flights', 'aria-label': 'Flights' });
  private readonly envelope = new EnvelopeView();
  private readonly differences = h('section', { class: 'sweep-differences' });
  private readonly results: SweepResultsView;
  private readonly message = h('div', { class: 'log-message', 'data-role': 'sweep-message' });

  constructor(private readonly context: Context) {
    this.head = new SweepHead(context);
    this.form = new SweepFormView(context);
    this.results = new SweepResultsView(context);
    this.add.addEventListener('click', () => void context.sweeps.form.open());
    const close = h(
      'button',
      { class: 'icon-button', 'aria-label': 'Close', onclick: () => context.sweeps.close() },
      '×',
    );
    this.root = h(
      'div',
      { class: 'sweep-page', role: 'dialog', 'aria-label': 'Sweeps' },
      h('header', { class: 'log-header' }, h('h2', {}, 'Sweeps'), close),
      h('div', { class: 'log-list sweep-list' }, this.add, viewerNote(), this.list),
      h(
        'div',
        { class: 'sweep-centre' },
        this.head.root,
        this.message,
        this.tools,
        h(
          'div',
          { class: 'sweep-body' },
          this.matrices,
          this.flights,
          this.envelope.root,
          this.differences,
          this.results.root,
        ),
        this.form.root,
      ),
    );
  }

  update(changed: ReadonlySet<Topic>): void {
    if (!changed.has('sweeps')) return;
    const { sweepPage: page } = this.context.store.state;
    if (!page.open) return;
    this.drawList(page.sweeps ?? [], page.name);
    this.form.draw();
    setText(this.message, this.messageText());
    this.message.hidden = this.message.textContent === '';
    this.message.classList.toggle('failed', page.error !== null);
    const { shown } = page;
    for (const part of [this.head.root, this.tools, this.matrices]) {
      part.hidden = shown === null;
    }
    this.results.root.hidden = shown === null || shown.table === null;
    this.envelope.draw(shown);
    if (shown === null) {
      this.flights.hidden = true;
      this.differences.hidden = true;
      return;
    }
    this.head.draw(shown, page.sweeps ?? []);
    const matrices = matricesOf(shown, page);
    this.drawTools(matrices);
    this.drawMatrices(matrices);
    this.drawFlights(shown);
    this.drawDifferences(shown);
    if (shown.table !== null) this.results.draw(shown.sweep, page.sweeps ?? []);
  }

  private messageText(): string {
    const { mayChange, sweepPage } = this.context.store.state;
    const { error, sweeps } = sweepPage;
    if (error !== null) return error;
    if (sweeps === null) return 'Reading';
    if (sweeps.length === 0) {
      if (!mayChange) return 'There are no sweeps yet.';
      return 'There are no sweeps yet. Start one with New sweep, or by overfly sweep FILE --out sweeps/NAME.';
    }
    return '';
  }

  private drawList(sweeps: readonly SweepEntry[], chosen: string | null): void {
    this.drawn.show(
      sweeps.map((sweep) => ({
        id: sweep.name,
        key: '',
        make: () => this.entry(sweep.name),
        refresh: (entry) => {
          setAttribute(entry, 'aria-current', sweep.name === chosen ? 'true' : null);
          setTextOf(entry, '.sweep-detail', sweepDetail(sweep));
        },
      })),
    );
  }

  private entry(name: string): HTMLElement {
    return h(
      'li',
      { class: 'log-row' },
      h(
        'button',
        {
          class: 'log-choice',
          'data-sweep': name,
          onclick: () => void this.context.sweeps.choose(name),
        },
        h('span', { class: 'log-name' }, name),
        h('span', { class: 'sweep-detail' }),
      ),
    );
  }

  private drawTools(matrices: Matrices | null): void {
    const { figure } = this.context.store.state.sweepPage;
    this.tools.hidden = matrices === null;
    if (matrices === null) return;
    const { columns, rows, panels, panelChoices, others } = matrices;
    const axes = [columns, ...(rows.name === '' ? [] : [rows]), ...panelChoices];
    const key = JSON.stringify([figure, columns.name, rows.name, panels?.name, others, axes]);
    rebuild(this.tools, key, () => [
      labelled(
        'Show',
        select(
          'sweep-figure',
          kSweepFigures.map(({ name, label }) => [name, label]),
          figure,
          (value) => this.context.sweeps.chooseFigure(value as SweepFigure),
        ),
      ),
      ...(axes.length < 2
        ? []
        : (['columns', 'rows'] as const).map((place) =>
            labelled(
              place === 'columns' ? 'Columns' : 'Rows',
              select(
                `sweep-${place}`,
                axes.map(({ name, label }) => [name, label]),
                matrices[place].name,
                (value) =>
                  this.context.sweeps.chooseAxis(place, value, {
                    columns: columns.name,
                    rows: rows.name,
                  }),
              ),
            ),
          )),
      ...(panelChoices.length === 0
        ? []
        : [
            labelled(
              'Side by side',
              select(
                'sweep-panels',
                [['', 'none'], ...panelChoices.map(({ name, label }) => [name, label] as const)],
                panels?.name ?? '',
                (value) => this.context.sweeps.choosePanels(value),
              ),
            ),
          ]),
      ...others.map(({ axis, value }) =>
        labelled(
          axis.label,
          select(
            `sweep-fix-${axis.name}`,
            axis.values.map((one) => [JSON.stringify(one), valueText(one, axis.unit)]),
            value,
            (text) => this.context.sweeps.fix(axis.name, text),
          ),
        ),
      ),
    ]);
  }

  private drawMatrices(matrices: Matrices | null): void {
    const { figure, cell } = this.context.store.state.sweepPage;
    this.matrices.hidden = matrices === null;
    if (matrices === null) return;
    rebuild(this.matrices, JSON.stringify([matrices, figure, cell]), () =>
      matrices.matrices.map((matrix) => this.matrix(matrices, matrix, figure)),
    );
  }

  private matrix({ columns, rows }: Matrices, matrix: Matrix, figure: SweepFigure): HTMLElement {
    const unit = kSweepFigures.find(({ name }) => name === figure)?.unit ?? '';
    const corner = rows.name === '' ? '' : axisTitle(rows);
    return h(
      'table',
      {
        class: 'sweep-matrix',
        'data-estimator': matrix.estimator,
        'data-panel-value': matrix.panel === '' ? undefined : matrix.panel,
      },
      h(
        'caption',
        {},
        h('b', {}, matrix.estimator),
        matrix.baseline ? h('span', { class: 'chip small' }, 'baseline') : null,
        matrix.panel === '' ? null : h('span', { class: 'panel-value' }, matrix.panel),
        unit === '' ? null : h('span', { class: 'unit' }, ` [${unit}]`),
      ),
      h(
        'thead',
        {},
        h(
          'tr',
          {},
          h('th', { class: 'axis' }, corner),
          h('th', { class: 'axis', colspan: columns.values.length }, axisTitle(columns)),
        ),
        h(
          'tr',
          {},
          h('th', {}),
          ...columns.values.map((value) => h('th', { scope: 'col' }, valueText(value, ''))),
        ),
      ),
      h(
        'tbody',
        {},
        ...matrix.rows.map((cells, i) =>
          h(
            'tr',
            {},
            h(
              'th',
              { scope: 'row' },
              rows.name === '' ? '' : valueText(rows.values[i] ?? null, ''),
            ),
            ...cells.map((cell) => this.cell(cell, figure)),
          ),
        ),
      ),
    );
  }

  private cell(cell: MatrixCell, figure: SweepFigure): HTMLElement {
    const chosen = this.context.store.state.sweepPage.cell === cell.key;
    if (cell.row === undefined) return h('td', { title: cell.hint });
    const kind = cell.failed ? 'failed' : figure === 'outcome' && cell.share === 1 ? 'all' : 'some';
    // Without a colour for cells that no estimator survived: the letter says it.
    const style =
      cell.share === null ? '' : `--share:${Math.round(Math.max(0, cell.share) * 100)}%`;
    return h(
      'td',
      {},
      h(
        'button',
        {
          class: 'sweep-cell',
          'data-of': cell.key,
          'data-kind': kind,
          'data-figure': figure === 'outcome' || figure === 'success' ? 'rate' : 'error',
          'aria-pressed': chosen ? 'true' : 'false',
          title: cell.hint,
          style,
          onclick: () => this.context.sweeps.chooseCell(cell.key),
        },
        cell.text,
      ),
    );
  }

  private drawFlights(shown: SweepState): void {
    const { cell } = this.context.store.state.sweepPage;
    const rows = cell === null ? [] : rowsOfCell(shown, cell);
    this.flights.hidden = rows.length === 0;
    if (rows.length === 0) return;
    rebuild(this.flights, JSON.stringify(rows), () => [
      h('h3', {}, cellTitle(shown, rows[0])),
      h(
        'table',
        { class: 'errors' },
        h(
          'thead',
          {},
          h(
            'tr',
            {},
            ...[
              'Estimator',
              'Outcome',
              'Success rate, 95 %',
              'Position RMSE, Sim3',
              'Rotation RMSE, Sim3',
              'Position RMSE, initial scale',
              'Flights',
            ].map((text) => h('th', { scope: 'col' }, text)),
          ),
        ),
        h('tbody', {}, ...rows.map((row) => this.flightRow(row))),
      ),
    ]);
  }

  private flightRow(row: SweepRow): HTMLElement {
    const [low, high] = row.success_rate_95;
    const rate = row.flights === 0 ? null : row.completed / row.flights;
    const good = row.flights > 0 && row.completed === row.flights;
    const { sim3, paper } = row.errors;
    return h(
      'tr',
      { 'data-estimator': row.estimator },
      h('th', { scope: 'row' }, row.estimator),
      h('td', { class: good ? 'good' : 'bad' }, outcomesText(row)),
      h(
        'td',
        {},
        `${formatPercent(rate, 0)} [${formatPercent(low, 0)}, ${formatPercent(high, 0)}]`,
      ),
      h('td', {}, spreadText(sim3.position_m, 'm')),
      h('td', {}, spreadText(sim3.rotation_deg, 'deg')),
      h('td', {}, spreadText(paper.position_m, 'm')),
      h(
        'td',
        { class: 'sweep-runs' },
        ...row.runs.map((id, i) =>
          h(
            'button',
            { class: 'tab', 'data-run': id, onclick: () => this.context.sweeps.openRun(id) },
            row.runs.length === 1 ? 'Open' : `${i + 1}`,
          ),
        ),
      ),
    );
  }

  private drawDifferences({ table }: SweepState): void {
    const { figure } = this.context.store.state.sweepPage;
    const name = figure.startsWith('paper') ? 'paper' : 'sim3';
    const convention = table?.conventions[name];
    const differences = convention?.differences ?? [];
    this.differences.hidden = differences.length === 0;
    rebuild(this.differences, JSON.stringify(convention), () => [
      h('h3', {}, 'Differences between estimators'),
      h('p', { class: 'muted' }, convention?.words ?? ''),
      h('ul', {}, ...differences.map((difference) => h('li', {}, differenceText(difference)))),
    ]);
  }
}

function axisTitle({ label, unit }: { label: string; unit: string }): string {
  return unit === '' ? label : `${label} [${unit}]`;
}

function cellTitle({ sweep }: SweepState, row: SweepRow | undefined): string {
  return sweep.axes
    .map(({ name, label, unit }) => `${label} ${valueText(row?.cell[name] ?? null, unit)}`)
    .join(', ');
}
