// The estimate: parameters with their uncertainty, warnings, where to save it, and the views.
import { formatNumber, kNothing } from '../../store/format';
import type { ParameterRow, ViewRow } from '../../store/calibration/calibration_results';
import { parameterRows, viewRows } from '../../store/calibration/calibration_results';
import type { CalibrationSolution } from '../../protocol/calibration_types';
import { h, rebuild, setText } from '../dom';
import type { Context } from '../view';

const kLeastViews = 4;

export class ResultView {
  readonly root: HTMLElement;
  private readonly estimate = h(
    'button',
    { class: 'primary', 'data-role': 'estimate', 'data-changes': true },
    'Estimate',
  );
  private readonly summary = h('p', { class: 'calibration-summary', 'data-role': 'summary' });
  private readonly parameters = h('table', { class: 'errors', 'data-role': 'parameters' });
  private readonly warnings = h('ul', { class: 'calibration-warnings' });
  private readonly views = h('table', { class: 'errors view-table', 'data-role': 'views' });
  private readonly name = h('input', {
    type: 'text',
    id: 'calibration-result-name',
    maxlength: 60,
    spellcheck: false,
  });
  private readonly save = h(
    'button',
    { class: 'secondary', 'data-role': 'save-calibration' },
    'Save',
  );
  private readonly saving = h('div', { class: 'calibration-save', 'data-changes': true });

  constructor(private readonly context: Context) {
    const { calibration } = context;
    this.estimate.addEventListener('click', () => void calibration.solve());
    this.name.addEventListener('input', () => {
      context.store.state.calibrationPage.name = this.name.value;
      this.updateSaving();
    });
    this.save.addEventListener('click', () => void calibration.save(this.name.value.trim()));
    this.saving.append(h('label', { for: this.name.id }, 'Name'), this.name, this.save);
    this.root = h(
      'div',
      { class: 'calibration-result' },
      this.estimate,
      this.summary,
      this.parameters,
      this.warnings,
      this.saving,
      h('div', { class: 'view-list' }, this.views),
    );
  }

  update(): void {
    const page = this.context.store.state.calibrationPage;
    const { session, solution, selected, busy, name } = page;
    this.root.hidden = session === null;
    if (session === null) return;
    this.estimate.disabled =
      busy || session.phase === 'solving' || session.views.length < kLeastViews;
    setText(this.estimate, solution === null ? 'Estimate the camera' : 'Estimate again');
    this.estimate.title = `At least ${kLeastViews} views are needed`;
    setText(this.summary, solution === null ? '' : summaryText(solution));
    this.drawParameters(solution);
    rebuild(this.warnings, JSON.stringify(solution?.warnings ?? []), () =>
      (solution?.warnings ?? []).map((text) => h('li', {}, text)),
    );
    this.drawViews(viewRows(page), selected);
    if (this.name.value !== name) this.name.value = name;
    this.updateSaving();
  }

  private updateSaving(): void {
    const { solution, sources, busy, name } = this.context.store.state.calibrationPage;
    this.saving.hidden = solution === null || sources?.keeps === false;
    this.save.disabled = busy || name.trim() === '';
  }

  private select(view: number): void {
    const { selected } = this.context.store.state.calibrationPage;
    void this.context.calibration.select(selected === view ? null : view);
  }

  private drawParameters(solution: CalibrationSolution | null): void {
    const rows = solution === null ? [] : parameterRows(solution);
    this.parameters.hidden = rows.length === 0;
    const known = rows.some(({ truth }) => truth !== null);
    rebuild(this.parameters, JSON.stringify(rows), () => [
      h(
        'thead',
        {},
        h(
          'tr',
          {},
          h('th', { scope: 'col' }, ''),
          h('th', { scope: 'col' }, 'Estimate'),
          h(
            'th',
            { scope: 'col', title: 'Standard deviation by the noise of the corners' },
            '± 1 σ',
          ),
          known ? h('th', { scope: 'col' }, 'Truth') : null,
          known ? h('th', { scope: 'col' }, 'Error') : null,
        ),
      ),
      h('tbody', {}, ...rows.map((row) => parameterRow(row, known))),
    ]);
  }

  private drawViews(rows: readonly ViewRow[], selected: number | null): void {
    this.views.hidden = rows.length === 0;
    rebuild(this.views, JSON.stringify([rows, selected]), () => [
      h(
        'thead',
        {},
        h(
          'tr',
          {},
          h('th', { scope: 'col', title: 'In the estimate' }, 'Use'),
          h('th', { scope: 'col' }, 'View'),
          h('th', { scope: 'col' }, 'RMS', h('span', { class: 'unit' }, ' px')),
          h('th', { scope: 'col' }, 'Max', h('span', { class: 'unit' }, ' px')),
          h(
            'th',
            { scope: 'col', title: '0 = parallel to the image' },
            'Tilt',
            h('span', { class: 'unit' }, ' deg'),
          ),
        ),
      ),
      h('tbody', {}, ...rows.map((row) => this.viewRow(row, row.view === selected))),
    ]);
    // A refused request leaves the rows as they were, but the viewer has changed the box.
    this.views.querySelectorAll('input').forEach((box, i) => {
      box.checked = rows[i]?.leftOut === false;
    });
  }

  private viewRow(row: ViewRow, selected: boolean): HTMLElement {
    const box = h('input', {
      type: 'checkbox',
      'data-changes': true,
      'aria-label': `Use view ${row.view + 1}`,
      onchange: () => void this.context.calibration.toggleView(row.view),
    });
    const figure = (value: number | null, digits: number) =>
      h('td', {}, value === null ? kNothing : formatNumber(value, digits));
    return h(
      'tr',
      { 'data-view': row.view, 'aria-selected': selected ? 'true' : 'false' },
      h('td', {}, box),
      h(
        'th',
        { scope: 'row' },
        h(
          'button',
          { class: 'view-name', title: row.name, onclick: () => this.select(row.view) },
          `${row.view + 1} ${row.name}`,
        ),
        row.outlier
          ? h(
              'span',
              { class: 'chip small warn', title: 'Does not fit the other views; has no part' },
              'outlier',
            )
          : null,
      ),
      figure(row.rms_px, 3),
      figure(row.max_px, 3),
      figure(row.tilt_deg, 1),
    );
  }
}

function summaryText({ rms_px, max_px, views, width_px, height_px }: CalibrationSolution): string {
  return (
    `RMS ${formatNumber(rms_px, 3)} px, largest ${formatNumber(max_px, 3)} px, ` +
    `${views.length} views of ${width_px} x ${height_px} px`
  );
}

function parameterRow({ name, unit, value, deviation, truth }: ParameterRow, known: boolean) {
  const digits = unit === 'px' ? 3 : 5;
  const cell = (text: string) => h('td', {}, text);
  const error = truth === null ? kNothing : signed(value - truth, digits);
  return h(
    'tr',
    { 'data-parameter': name },
    h('th', { scope: 'row' }, name, unit === '' ? null : h('span', { class: 'unit' }, ` ${unit}`)),
    cell(formatNumber(value, digits)),
    cell(formatNumber(deviation, digits)),
    known ? cell(truth === null ? kNothing : formatNumber(truth, digits)) : null,
    known ? cell(error) : null,
  );
}

function signed(value: number, digits: number): string {
  return `${value >= 0 ? '+' : ''}${formatNumber(value, digits)}`;
}
