// The server's runs: searched, ordered, tagged, opened.
import { textureHint } from '../../store/error_table';
import { formatDate, formatDuration, formatNumber } from '../../store/format';
import type { RunOrder } from '../../store/runs/run_order';
import { bestFirst, isRunOrder, kRunOrders, ordered } from '../../store/runs/run_order';
import { matching } from '../../store/runs/run_search';
import type { EstimatorResult, Run } from '../../protocol/rest_types';
import { isActive } from '../../protocol/rest_types';
import type { Topic } from '../../store/state';
import { failedEstimators } from '../../store/studies/study_form';
import { h, rebuild } from '../dom';
import { icon } from '../icons';
import type { Panel } from '../panel';
import { makePanel } from '../panel';
import { notesForm } from './notes_form';
import { ShownRuns } from './shown_runs';
import type { Context, View } from '../view';

const kConfirm_ms = 3000;
/** Estimators whose results an entry shows. */
const kShownResults = 3;

export class RunList implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly list = h('ul', { class: 'runs' });
  private readonly shown: ShownRuns;
  private readonly search = h('input', {
    type: 'search',
    id: 'run-search',
    placeholder: 'Search',
    'aria-label': 'Search the runs',
    title: 'Words of title, id, scenario, estimators, status, outcome, tags or note',
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
  private readonly find = h('div', { class: 'run-find' }, this.search, this.order);
  /** Tags and note of the run that is being edited. */
  private readonly notes = h('div', { class: 'run-notes', hidden: true });
  /** The run whose deletion awaits confirmation. */
  private confirming: string | null = null;

  constructor(private readonly context: Context) {
    this.panel = makePanel('runs', 'Runs');
    this.shown = new ShownRuns(context);
    this.panel.body.append(this.shown.root, this.find, this.notes, this.list);
    this.search.addEventListener('input', () => this.draw());
    this.order.addEventListener('change', () => this.draw());
    this.root = this.panel.root;
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('lists') || changed.has('run')) this.draw();
  }

  private draw(): void {
    const { state } = this.context.store;
    const { runs, runId, listError } = state;
    const found = ordered(matching(runs ?? [], this.search.value), this.chosenOrder());
    const shown = state.watched.map(({ id }) => id);
    rebuild(this.list, JSON.stringify([found, runId, shown, this.confirming]), () =>
      found.map((run) => this.entry(run, run.id === runId)),
    );
    this.shown.draw(state);
    this.find.hidden = (runs?.length ?? 0) < 2;
    if (runs === null) this.panel.showEmpty(listError ?? 'Reading the runs');
    else if (runs.length === 0) this.panel.showEmpty('No runs yet. Launch a flight above.');
    else this.panel.showEmpty(found.length === 0 ? 'No run has all of these words.' : null);
  }

  private chosenOrder(): RunOrder {
    return isRunOrder(this.order.value) ? this.order.value : 'newest';
  }

  private entry(run: Run, selected: boolean): HTMLElement {
    const share = run.frames_total > 0 ? run.frames / run.frames_total : 0;
    const length = run.duration_ns > 0 ? `${formatNumber(run.duration_ns / 1e9, 0)} s` : '';
    const flight = run.flight === '' ? run.scenario : run.flight;
    const detail = [
      formatDate(run.created_utc),
      length,
      run.results.length > 0 ? resultsText(run) : run.estimators.join(', ') || 'no estimators',
      progressText(run),
    ].filter((part) => part !== '');
    return h(
      'li',
      {
        class: 'run',
        'data-run': run.id,
        'data-status': run.status,
        'aria-current': selected ? 'true' : 'false',
      },
      h(
        'button',
        {
          class: 'run-open',
          title: run.error ?? run.problem ?? run.id,
          onclick: () => this.context.session.selectRun(run.id),
        },
        h('span', { class: 'run-name' }, run.title || run.scenario),
        h('span', { class: 'run-detail', 'data-role': 'flight', title: flight }, flight),
        h(
          'span',
          { class: 'run-detail', 'data-role': 'detail', title: resultsHint(run) },
          detail.join(' · '),
        ),
        isActive(run)
          ? h(
              'span',
              { class: 'progress' },
              h('i', { style: `width:${(share * 100).toFixed(1)}%` }),
            )
          : null,
      ),
      h('span', { class: 'run-chips' }, ...chips(run), ...this.marks(run)),
      h(
        'span',
        { class: 'run-buttons' },
        ...this.explainButton(run),
        this.notesButton(run),
        this.repeatButton(run),
        this.compareButton(run),
        isActive(run) ? this.cancelButton(run) : this.deleteButton(run),
      ),
    );
  }

  /** Tags, which search for themselves, and whether there is a note. */
  private marks(run: Run): HTMLElement[] {
    const tags = run.tags.map((tag) =>
      h(
        'button',
        {
          class: 'chip small tag',
          title: `Find the runs with "${tag}"`,
          onclick: () => {
            this.search.value = tag;
            this.draw();
          },
        },
        tag,
      ),
    );
    const note =
      run.note === ''
        ? []
        : [h('span', { class: 'chip small', 'data-role': 'note', title: run.note }, 'note')];
    return [...tags, ...note];
  }

  /** Only where an estimator failed. */
  private explainButton(run: Run): HTMLElement[] {
    const failed = failedEstimators(run);
    if (failed.length === 0) return [];
    return [
      h(
        'button',
        {
          class: 'icon-button',
          title: `Explain why ${failed.join(', ')} failed`,
          'aria-label': `Explain the failure: ${run.title}`,
          'data-role': 'explain',
          onclick: () => void this.context.studies.explain(run),
        },
        icon('question'),
      ),
    ];
  }

  private notesButton(run: Run): HTMLElement {
    return h(
      'button',
      {
        class: 'icon-button',
        title: isActive(run) ? 'Can be tagged once it has ended' : 'Tags and note',
        'aria-label': `Tags and note: ${run.title}`,
        'data-role': 'edit-notes',
        disabled: isActive(run),
        onclick: () => this.editNotes(run),
      },
      icon('pencil'),
    );
  }

  private editNotes(run: Run): void {
    const { catalogue, store } = this.context;
    const close = () => {
      this.notes.hidden = true;
      this.notes.replaceChildren();
    };
    const save = async (tags: string[], note: string) => {
      if (await catalogue.setNotes(run.id, tags, note)) close();
    };
    this.notes.replaceChildren(
      notesForm(run, store.state.runs ?? [], (tags, note) => void save(tags, note), close),
    );
    this.notes.hidden = false;
    this.notes.querySelector('input')?.focus();
  }

  /** Without a run shown, there is nothing to compare with. */
  private compareButton(run: Run): HTMLElement {
    const { session, store } = this.context;
    const { watched } = store.state;
    const isShown = watched.some(({ id }) => id === run.id);
    const label = isShown ? 'Remove from the comparison' : 'Show together with the others';
    return h(
      'button',
      {
        class: 'icon-button compare',
        title: label,
        'aria-label': `${label}: ${run.title}`,
        'aria-pressed': isShown && watched.length > 1 ? 'true' : 'false',
        disabled: watched.length === 0 || (isShown && watched.length === 1),
        onclick: () => {
          if (isShown) session.removeRun(run.id);
          else session.addRun(run.id);
        },
      },
      icon('add'),
    );
  }

  private repeatButton(run: Run): HTMLElement {
    const { catalogue, layouts } = this.context;
    const again = async () => {
      await catalogue.repeat(run);
      layouts.show('launcher');
    };
    return h(
      'button',
      {
        class: 'icon-button',
        title: 'Fly again with changes: its settings are shown in Launch',
        'aria-label': `Fly again with changes: ${run.title}`,
        'data-role': 'repeat',
        onclick: () => void again(),
      },
      icon('repeat'),
    );
  }

  private cancelButton(run: Run): HTMLElement {
    return h(
      'button',
      {
        class: 'icon-button',
        title: 'Stop this run; its data so far is kept',
        'aria-label': 'Stop this run',
        onclick: () => void this.context.catalogue.cancel(run.id),
      },
      icon('stop'),
    );
  }

  private deleteButton(run: Run): HTMLElement {
    const asked = this.confirming === run.id;
    return h(
      'button',
      {
        class: asked ? 'icon-button danger' : 'icon-button',
        title: asked ? 'Click again to delete this run for good' : 'Delete this run',
        'aria-label': asked ? 'Confirm deletion' : 'Delete this run',
        onclick: () => {
          if (asked) void this.context.catalogue.remove(run.id);
          this.ask(asked ? null : run.id);
        },
      },
      asked ? 'Delete?' : icon('bin'),
    );
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

/** Place in the queue, or time left; '' if neither is known. */
function progressText(run: Run): string {
  if (run.queue_position !== null) {
    return run.queue_position === 1 ? 'next' : `${run.queue_position - 1} before it`;
  }
  return run.left_s === null ? '' : `${formatDuration(run.left_s)} left`;
}

/** The best estimators with their errors. */
function resultsText({ results }: Run): string {
  const best = bestFirst(results);
  const more = best.length > kShownResults ? [`${best.length - kShownResults} more`] : [];
  return [...best.slice(0, kShownResults).map(resultText), ...more].join(' · ');
}

/** All of them, one a line; undefined before the run is scored. */
function resultsHint({ results }: Run): string | undefined {
  return results.length > 0 ? bestFirst(results).map(resultText).join('\n') : undefined;
}

/** So that an error has at least two figures. */
function digitsOf(error_m: number): number {
  if (error_m < 1) return 3;
  return error_m < 10 ? 2 : 1;
}

/** "feature 0.083 m", "feature LOST 12.3 m". */
function resultText({ estimator, outcome, position_rmse_m }: EstimatorResult): string {
  const word = outcome === 'COMPLETED' ? [] : [outcome];
  const error =
    position_rmse_m === null
      ? []
      : [`${formatNumber(position_rmse_m, digitsOf(position_rmse_m))} m`];
  return [estimator, ...word, ...error].join(' ');
}

/** Status, and what is wrong with the run. */
function chips(run: Run): HTMLElement[] {
  return [
    h('span', { class: 'chip small', 'data-status': run.status }, run.status),
    run.problem !== null
      ? h(
          'span',
          { class: 'chip small warn', 'data-role': 'problem', title: run.problem },
          'damaged',
        )
      : null,
    run.texture_limited
      ? h(
          'span',
          {
            class: 'chip small texture-limited',
            'data-role': 'texture-limited',
            title: textureHint(null),
          },
          'texture-limited',
        )
      : null,
  ].filter((chip) => chip !== null);
}
