// Controls that filter the list of runs: behind a button, because the list is narrow.
import type { FilterField, RunFilter } from '../../store/runs/run_filter';
import { filterChoices, isFiltering, kNoFilter } from '../../store/runs/run_filter';
import type { Run } from '../../protocol/rest_types';
import { h, rebuild } from '../dom';

const kFields: readonly { field: FilterField; label: string; any: string }[] = [
  { field: 'estimator', label: 'Estimator', any: 'Any estimator' },
  { field: 'outcome', label: 'Outcome', any: 'Any outcome' },
  { field: 'scenario', label: 'Scenario', any: 'Any scenario' },
  { field: 'tag', label: 'Tag', any: 'Any tag' },
];
const kId = 'run-filters';

export class RunFilters {
  readonly root: HTMLElement;
  readonly button = h(
    'button',
    {
      class: 'secondary',
      id: 'run-filter',
      'aria-expanded': 'false',
      'aria-controls': kId,
      title: 'Filter by estimator, outcome, scenario and tag',
      onclick: () => this.open(this.root.hidden),
    },
    'Filter',
  );
  private readonly selects = kFields.map(({ field, label }) => {
    const select = h('select', { 'aria-label': label, 'data-filter': field });
    select.addEventListener('change', () => {
      this.chosen = { ...this.chosen, [field]: select.value };
      this.onChange();
    });
    return select;
  });
  /** Shown while the list is filtered. */
  readonly clear = h(
    'button',
    {
      class: 'secondary',
      'data-role': 'clear-filter',
      onclick: () => {
        this.chosen = kNoFilter;
        this.button.focus();
        this.onChange();
      },
    },
    'Clear filter',
  );
  private chosen: RunFilter = kNoFilter;

  /** @param onChange  called when `filter` has changed */
  constructor(private readonly onChange: () => void) {
    this.root = h('div', { class: 'run-filters', id: kId, hidden: true });
    this.root.append(...this.selects);
  }

  get filter(): RunFilter {
    return this.chosen;
  }

  /** Offers what these runs have. */
  update(runs: readonly Run[]): void {
    this.button.setAttribute('aria-pressed', isFiltering(this.chosen) ? 'true' : 'false');
    this.clear.hidden = !isFiltering(this.chosen);
    if (this.root.hidden) return;
    const choices = filterChoices(runs);
    kFields.forEach(({ field, any }, i) => {
      const select = this.selects[i];
      if (select === undefined) return;
      const chosen = this.chosen[field];
      const offered = choices[field];
      // What no run has any more stays visible while it is chosen.
      const gone = chosen !== '' && offered.every(({ value }) => value !== chosen);
      const all = gone ? [...offered, { value: chosen, runs: 0 }] : offered;
      rebuild(select, JSON.stringify(all), () => [
        h('option', { value: '' }, any),
        ...all.map(({ value, runs: count }) => h('option', { value }, `${value} (${count})`)),
      ]);
      select.value = chosen;
      select.disabled = all.length === 0;
    });
  }

  private open(open: boolean): void {
    this.root.hidden = !open;
    this.button.setAttribute('aria-expanded', open ? 'true' : 'false');
    this.onChange();
    if (open) this.selects[0]?.focus();
  }
}
