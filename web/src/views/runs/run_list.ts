// The server's runs: searched, filtered, ordered, tagged, opened.
import { isRunOrder, kRunOrders, ordered } from '../../store/runs/run_order';
import { filtered, isFiltering } from '../../store/runs/run_filter';
import { kSearchFields, matching, searchFor } from '../../store/runs/run_search';
import { runTraits } from '../../store/runs/run_traits';
import type { Run } from '../../protocol/rest_types';
import type { State, Topic } from '../../store/state';
import { h, setText } from '../dom';
import { KeyedList } from '../keyed_list';
import type { Panel } from '../panel';
import { makePanel } from '../panel';
import { notesForm } from './notes_form';
import { RunEntries } from './run_entry';
import { RunFilters } from './run_filters';
import { ShownRuns } from './shown_runs';
import type { Context, View } from '../view';

const kConfirm_ms = 3000;
/** Entries that are drawn at first, and as many more whenever the end of the list is seen. */
const kStep = 50;

export class RunList implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly list = h('ul', { class: 'runs' });
  private readonly entries: RunEntries;
  private readonly drawn = new KeyedList(this.list);
  private readonly filters = new RunFilters(() => this.drawFromStart());
  private readonly shown: ShownRuns;
  private readonly search = h('input', {
    type: 'search',
    id: 'run-search',
    placeholder: 'Search',
    'aria-label': 'Search the runs',
    title: `Words of title, id, flight, estimators, status, outcome, tags or note, or of one field: ${kSearchFields.map((field) => `${field}:`).join(' ')}`,
  });
  private readonly order = h(
    'select',
    {
      id: 'run-order',
      'aria-label': 'Order of the runs',
      title: 'Errors: the smallest position RMSE of the run, alignment init_scale',
    },
    ...Object.entries(kRunOrders).map(([value, text]) => h('option', { value }, text)),
  );
  private readonly find = h(
    'div',
    { class: 'run-find' },
    this.search,
    this.order,
    this.filters.button,
  );
  private readonly count = h('span', { role: 'status' });
  private readonly counted = h('div', { class: 'run-count' }, this.count, this.filters.clear);
  private readonly more = h('button', {
    class: 'secondary run-more',
    onclick: () => this.drawMore(),
  });
  /** Tags and note of the run that is being edited. */
  private readonly notes = h('div', { class: 'run-notes', hidden: true, 'data-changes': true });
  /** The run whose deletion awaits confirmation. */
  private confirming: string | null = null;
  /** Entries to be drawn. */
  private most = kStep;

  constructor(private readonly context: Context) {
    this.panel = makePanel('runs', 'Runs');
    this.shown = new ShownRuns(context);
    this.entries = new RunEntries(context, {
      findTag: (tag) => {
        this.search.value = searchFor('tag', tag);
        this.drawFromStart();
      },
      editNotes: (run) => this.editNotes(run),
      confirm: (id) => this.ask(id),
    });
    const found = [this.find, this.filters.root, this.counted, this.notes, this.list, this.more];
    this.panel.body.append(this.shown.root, ...found);
    this.search.addEventListener('input', () => this.drawFromStart());
    this.order.addEventListener('change', () => this.drawFromStart());
    new IntersectionObserver(([seen]) => {
      if (seen?.isIntersecting === true) this.drawMore();
    }).observe(this.more);
    this.root = this.panel.root;
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('lists') || changed.has('run')) this.draw();
  }

  private drawFromStart(): void {
    this.most = kStep;
    this.draw();
  }

  private drawMore(): void {
    this.most += kStep;
    this.draw();
  }

  private draw(): void {
    const { state } = this.context.store;
    const { runs, listError } = state;
    const all = runs ?? [];
    this.filters.update(all);
    const order = isRunOrder(this.order.value) ? this.order.value : 'newest';
    const chosen = filtered(all, this.filters.filter);
    const found = ordered(matching(chosen, this.search.value), order);
    this.drawEntries(all, found, state);
    this.shown.draw(state);
    this.find.hidden = all.length < 2;
    const some = found.length < all.length;
    setText(this.count, some ? `${found.length} of ${all.length} runs` : '');
    this.counted.hidden = !some;
    if (runs === null) this.panel.showEmpty(listError ?? 'Reading the runs');
    else if (runs.length === 0) this.panel.showEmpty(noRunsText(state));
    else this.panel.showEmpty(found.length === 0 ? this.nothingText() : null);
  }

  private drawEntries(all: readonly Run[], found: readonly Run[], state: State): void {
    const { runId } = state;
    // The run that is shown is marked in the list, wherever it is.
    const current = found.findIndex(({ id }) => id === runId);
    const most = Math.max(this.most, current + 1);
    const watched = new Set(state.watched.map(({ id }) => id));
    const traits = runTraits(all);
    this.drawn.show(
      found.slice(0, most).map((run) => {
        const entry = {
          traits: traits.get(run.id) ?? { differing: [], common: [] },
          selected: run.id === runId,
          shown: watched.has(run.id),
          watched: watched.size,
          confirming: this.confirming === run.id,
        };
        return {
          id: run.id,
          key: this.entries.key(run, entry),
          make: () => this.entries.entry(run, entry),
          refresh: (element) => this.entries.showProgress(element, run),
        };
      }),
    );
    const rest = found.length - most;
    this.more.hidden = rest <= 0;
    setText(this.more, `Show ${Math.min(kStep, rest)} more of ${found.length}`);
  }

  private nothingText(): string {
    return isFiltering(this.filters.filter)
      ? 'No run has all of these words and passes the filter.'
      : 'No run has all of these words.';
  }

  private editNotes(run: Run): void {
    const { catalogue, store } = this.context;
    // Once saved, the form of another run may have taken its place.
    const close = () => {
      if (form.parentElement !== this.notes) return;
      this.notes.hidden = true;
      this.notes.replaceChildren();
    };
    const save = async (tags: string[], note: string) => {
      if (await catalogue.setNotes(run.id, tags, note)) close();
    };
    const form = notesForm(
      run,
      store.state.runs ?? [],
      (tags, note) => void save(tags, note),
      close,
    );
    this.notes.replaceChildren(form);
    this.notes.hidden = false;
    this.notes.querySelector('input')?.focus();
  }

  private ask(id: string | null): void {
    this.confirming = id;
    this.draw();
    if (id === null) return;
    window.setTimeout(() => {
      if (this.confirming === id) this.ask(null);
    }, kConfirm_ms);
  }
}

function noRunsText({ mayChange }: State): string {
  return mayChange ? 'No runs yet. Launch a flight above.' : 'No runs yet.';
}
