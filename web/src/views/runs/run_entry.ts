// An entry of the list of runs: what was flown, how it went, and what can be done with it.
import { textureHint } from '../../store/errors/error_table';
import { formatDate, formatDuration, formatNumber } from '../../store/format';
import { bestFirst } from '../../store/runs/run_order';
import type { RunTraits } from '../../store/runs/run_traits';
import { settledText } from '../../store/runs/settled_text';
import type { EstimatorResult, Run } from '../../protocol/rest_types';
import { isActive } from '../../protocol/rest_types';
import { failedEstimators } from '../../store/studies/study_form';
import { h, setTextOf } from '../dom';
import { icon } from '../icons';
import type { Context } from '../view';

/** Estimators whose results an entry shows. */
const kShownResults = 3;

/** What an entry shows in addition to the run. */
export interface EntryState {
  traits: RunTraits;
  selected: boolean;
  /** Shown, with the main run or without others. */
  shown: boolean;
  /** Number of runs that are shown. */
  watched: number;
  /** Its deletion awaits confirmation. */
  confirming: boolean;
}

/** What an entry asks of the list. */
export interface EntryActions {
  findTag: (tag: string) => void;
  editNotes: (run: Run) => void;
  /** Ask whether to delete a run; null = do not. */
  confirm: (id: string | null) => void;
}

export class RunEntries {
  constructor(
    private readonly context: Context,
    private readonly actions: EntryActions,
  ) {}

  entry(run: Run, state: EntryState): HTMLElement {
    return h(
      'li',
      {
        class: 'run',
        'data-run': run.id,
        'data-status': run.status,
        'aria-current': state.selected ? 'true' : 'false',
      },
      h(
        'button',
        {
          class: 'run-open',
          'data-role': 'open',
          title: run.error ?? run.problem ?? run.id,
          onclick: () => this.context.session.selectRun(run.id),
        },
        h('span', { class: 'run-name' }, run.title || run.scenario),
        traitsLine(state.traits),
        h('span', { class: 'run-detail', 'data-role': 'detail', title: resultsHint(run) }),
        isActive(run) ? h('span', { class: 'progress' }, h('i')) : null,
      ),
      h('span', { class: 'run-chips' }, ...chips(run), ...this.marks(run)),
      h(
        'span',
        { class: 'run-buttons' },
        ...this.explainButton(run),
        this.notesButton(run),
        this.repeatButton(run),
        this.compareButton(run, state),
        isActive(run) ? this.cancelButton(run) : this.deleteButton(run, state.confirming),
      ),
    );
  }

  /** What an entry shows but for the progress of its run. */
  key(run: Run, state: EntryState): string {
    return JSON.stringify([settledText(run), state]);
  }

  /** Shows the progress of its run in an entry. */
  showProgress(entry: HTMLElement, run: Run): void {
    setTextOf(entry, '[data-role=detail]', detailText(run));
    const bar = entry.querySelector<HTMLElement>('.progress i');
    if (bar !== null) bar.style.width = flownShare(run);
  }

  /** Tags, which search for themselves, and whether there is a note. */
  private marks(run: Run): HTMLElement[] {
    const tags = run.tags.map((tag) =>
      h(
        'button',
        {
          class: 'chip small tag',
          title: `Find the runs with "${tag}"`,
          onclick: () => this.actions.findTag(tag),
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
          'data-changes': true,
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
        'data-changes': true,
        disabled: isActive(run),
        onclick: () => this.actions.editNotes(run),
      },
      icon('pencil'),
    );
  }

  /** Without a run shown, there is nothing to compare with. */
  private compareButton(run: Run, { shown, watched }: EntryState): HTMLElement {
    const { session } = this.context;
    const label = shown ? 'Remove from the comparison' : 'Show together with the others';
    return h(
      'button',
      {
        class: 'icon-button compare',
        title: label,
        'aria-label': `${label}: ${run.title}`,
        'data-role': 'compare',
        'aria-pressed': shown && watched > 1 ? 'true' : 'false',
        disabled: watched === 0 || (shown && watched === 1),
        onclick: () => {
          if (shown) session.removeRun(run.id);
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
        'data-changes': true,
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
        'data-role': 'stop',
        'data-changes': true,
        onclick: () => void this.context.catalogue.cancel(run.id),
      },
      icon('stop'),
    );
  }

  private deleteButton(run: Run, asked: boolean): HTMLElement {
    return h(
      'button',
      {
        class: asked ? 'icon-button danger' : 'icon-button',
        title: asked ? 'Click again to delete this run for good' : 'Delete this run',
        'aria-label': asked ? 'Confirm deletion' : 'Delete this run',
        'data-role': 'delete',
        'data-changes': true,
        onclick: () => {
          if (asked) void this.context.catalogue.remove(run.id);
          this.actions.confirm(asked ? null : run.id);
        },
      },
      asked ? 'Delete?' : icon('bin'),
    );
  }
}

/** What differs from other runs of the title stands out. */
function traitsLine({ differing, common }: RunTraits): HTMLElement {
  const [first, rest] = [differing.join(', '), common.join(', ')];
  const gap = first !== '' && rest !== '' ? ' · ' : '';
  return h(
    'span',
    { class: 'run-detail', 'data-role': 'flight', title: [...differing, ...common].join(', ') },
    first === '' ? null : h('b', {}, first),
    gap + rest,
  );
}

/** When, how long, with what result, and what is still to come. */
function detailText(run: Run): string {
  const length = run.duration_ns > 0 ? `${formatNumber(run.duration_ns / 1e9, 0)} s` : '';
  return [
    formatDate(run.created_utc),
    length,
    hasFlown(run) ? resultsText(run) : run.estimators.join(', ') || 'no estimators',
    progressText(run),
  ]
    .filter((part) => part !== '')
    .join(' · ');
}

/** The part of the frames that are flown, "12.3%". */
function flownShare(run: Run): string {
  const share = run.frames_total > 0 ? run.frames / run.frames_total : 0;
  return `${(share * 100).toFixed(1)}%`;
}

/** Place in the queue, or time left; '' if neither is known. */
function progressText(run: Run): string {
  if (run.queue_position !== null) {
    return run.queue_position === 1 ? 'next' : `${run.queue_position - 1} before it`;
  }
  return run.left_s === null ? '' : `${formatDuration(run.left_s)} left`;
}

/** Whether its results are of anything. */
function hasFlown({ results, frames }: Run): boolean {
  return results.length > 0 && frames > 0;
}

/** The best estimators with their errors. */
function resultsText({ results }: Run): string {
  const best = bestFirst(results);
  const more = best.length > kShownResults ? [`${best.length - kShownResults} more`] : [];
  return [...best.slice(0, kShownResults).map(resultText), ...more].join(' · ');
}

/** All of them, one a line; undefined before the run is scored. */
function resultsHint(run: Run): string | undefined {
  return hasFlown(run) ? bestFirst(run.results).map(resultText).join('\n') : undefined;
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
