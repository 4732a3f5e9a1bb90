// The tables of a sweep as files, and its comparison with another one.
import type { SweepComparison, SweepEntry } from '../../protocol/sweep_types';
import { formatNumber, formatPercent } from '../../store/format';
import type { SweepResultsState, TableFormat } from '../../store/sweeps/sweep_results';
import { kTableFormats } from '../../store/sweeps/sweep_results';
import { download } from '../download';
import { h, rebuild } from '../dom';
import type { Context } from '../view';
import { labelled, select } from './sweep_controls';

const kQuantities: Record<string, { label: string; unit: string; digits: number }> = {
  success_rate: { label: 'Success rate', unit: '', digits: 0 },
  position_rmse_m: { label: 'Position RMSE', unit: 'm', digits: 3 },
  position_rmse_hold_m: { label: 'Position RMSE, held', unit: 'm', digits: 3 },
  rotation_rmse_deg: { label: 'Rotation RMSE', unit: 'deg', digits: 3 },
  position_auc: { label: 'Area under the curve of the error', unit: '', digits: 3 },
  coverage: { label: 'Coverage', unit: '', digits: 0 },
  initialised_at_s: { label: 'Initialised after', unit: 's', digits: 2 },
  reset_count: { label: 'Resets', unit: '', digits: 1 },
};
const kShares = new Set(['success_rate', 'coverage']);

export class SweepResultsView {
  readonly root: HTMLElement;
  private readonly files = h('section', { class: 'sweep-files', 'aria-label': 'Tables' });
  private readonly form = h('section', { class: 'sweep-compare', 'aria-label': 'Comparison' });
  private readonly answer = h('div', { class: 'sweep-comparison', 'data-role': 'comparison' });

  constructor(private readonly context: Context) {
    this.root = h('div', { class: 'sweep-results' }, this.files, this.form, this.answer);
  }

  draw(sweep: SweepEntry, all: readonly SweepEntry[]): void {
    const { results } = this.context.store.state.sweepPage;
    void this.context.sweeps.results.readPublished();
    this.drawFiles(sweep, results);
    this.drawForm(sweep, all, results);
    this.drawAnswer(results);
  }

  private drawFiles(
    { name }: SweepEntry,
    { published, publishedName, counterparts }: SweepResultsState,
  ) {
    rebuild(this.files, JSON.stringify([name, published, publishedName]), () => [
      h('h3', {}, 'Tables'),
      h(
        'div',
        { class: 'sweep-results-row' },
        ...kTableFormats.map(({ format, label }) =>
          h(
            'button',
            {
              class: 'secondary',
              'data-format': format,
              title: `Save errors, outcomes and differences as ${label}`,
              onclick: () => void this.save(name, format),
            },
            label,
          ),
        ),
        ...(published === null || published.length === 0
          ? []
          : [
              labelled(
                'Published errors',
                select(
                  'sweep-published',
                  [['', 'none'], ...published.map(same)],
                  publishedName,
                  (text) => this.context.sweeps.results.set({ publishedName: text }),
                ),
              ),
            ]),
        ...(publishedName === ''
          ? []
          : [
              labelled(
                'Estimators as published',
                h('input', {
                  type: 'text',
                  value: counterparts,
                  placeholder: 'feature=ORB-SLAM2',
                  'data-role': 'counterparts',
                  title:
                    'Which of these estimators stands for which published one, with commas between',
                  oninput: (event: Event) =>
                    this.context.sweeps.results.set({
                      counterparts: (event.target as HTMLInputElement).value,
                    }),
                }),
              ),
            ]),
      ),
    ]);
  }

  private async save(name: string, format: TableFormat): Promise<void> {
    const file = await this.context.sweeps.results.table(name, format);
    if (file !== null) download(file.fileName, file.content);
  }

  private drawForm(
    { name, estimators }: SweepEntry,
    all: readonly SweepEntry[],
    { baseline, estimator, conditions, comparing }: SweepResultsState,
  ): void {
    const others = all.filter((sweep) => sweep.name !== name).map((sweep) => sweep.name);
    this.form.hidden = others.length === 0;
    const key = JSON.stringify([name, estimators, others, baseline, estimator, comparing]);
    rebuild(this.form, key, () => [
      h('h3', {}, 'Compare with another sweep'),
      h(
        'div',
        { class: 'sweep-results-row' },
        labelled(
          'Baseline',
          select('compare-baseline', [['', 'choose'], ...others.map(same)], baseline, (text) =>
            this.context.sweeps.results.set({ baseline: text, comparison: null }),
          ),
        ),
        labelled(
          'Estimator',
          select('compare-estimator', [['', 'all'], ...estimators.map(same)], estimator, (text) =>
            this.context.sweeps.results.set({ estimator: text, comparison: null }),
          ),
        ),
        h(
          'button',
          {
            class: 'primary',
            'data-role': 'compare-sweeps',
            disabled: baseline === '' || comparing,
            title: 'Flight by flight: the same cell, repeat, seed and estimator',
            onclick: () => void this.context.sweeps.results.compare(name),
          },
          'Compare',
        ),
      ),
      labelled(
        'Fail if (a condition a line)',
        h(
          'textarea',
          {
            rows: 3,
            spellcheck: 'false',
            'data-role': 'compare-conditions',
            oninput: (event: Event) =>
              this.context.sweeps.results.set({
                conditions: (event.target as HTMLTextAreaElement).value,
              }),
          },
          conditions,
        ),
      ),
    ]);
  }

  private drawAnswer({ comparison }: SweepResultsState): void {
    this.answer.hidden = comparison === null;
    if (comparison === null) return;
    rebuild(this.answer, JSON.stringify(comparison), () =>
      typeof comparison === 'string'
        ? [h('p', { class: 'bad' }, comparison)]
        : comparisonParts(comparison),
    );
  }
}

function comparisonParts(comparison: SweepComparison): HTMLElement[] {
  const { pairs, without_pair, failed, quantities, conditions } = comparison;
  const left = `${without_pair} without a pair and ${failed} that failed are left out`;
  return [
    h('p', {}, `${pairs} flights in both sweeps; ${left}.`),
    h(
      'table',
      { class: 'errors' },
      h(
        'thead',
        {},
        h(
          'tr',
          {},
          ...['Median of', 'Flights', 'This sweep', 'Baseline'].map((text) =>
            h('th', { scope: 'col' }, text),
          ),
        ),
      ),
      h(
        'tbody',
        {},
        ...quantities.map(({ quantity, flights, sweep, baseline }) =>
          h(
            'tr',
            { 'data-quantity': quantity },
            h('th', { scope: 'row' }, quantityTitle(quantity)),
            h('td', {}, String(flights)),
            h('td', {}, valueOf(quantity, sweep)),
            h('td', {}, valueOf(quantity, baseline)),
          ),
        ),
      ),
    ),
    h(
      'ul',
      { class: 'sweep-conditions' },
      ...conditions.map(({ text, holds, left: value, right, problem }) =>
        h(
          'li',
          { 'data-holds': String(holds) },
          h(
            'span',
            { class: 'chip small', 'data-status': holds === false ? 'completed' : 'failed' },
            holds === null ? 'error' : holds ? 'failed' : 'passed',
          ),
          h('code', {}, text),
          h('span', { class: 'unit' }, problem ?? `${numberOf(value)} against ${numberOf(right)}`),
        ),
      ),
    ),
  ];
}

function quantityTitle(quantity: string): string {
  const known = kQuantities[quantity];
  if (known === undefined) return quantity;
  return known.unit === '' ? known.label : `${known.label} [${known.unit}]`;
}

function valueOf(quantity: string, value: number | null): string {
  if (value === null) return '–';
  if (kShares.has(quantity)) return formatPercent(value, 0);
  return formatNumber(value, kQuantities[quantity]?.digits ?? 3);
}

function numberOf(value: number | null): string {
  return value === null ? '–' : formatNumber(value, 4);
}

function same(name: string): readonly [string, string] {
  return [name, name];
}
