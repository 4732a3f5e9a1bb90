// Title, state and progress of a sweep, and the buttons that cancel, continue and delete it.
import type { SweepEntry, SweepState } from '../../protocol/sweep_types';
import { formatDate, formatDuration, formatPercent } from '../../store/format';
import { h, rebuild } from '../dom';
import type { Context } from '../view';

const kConfirm_ms = 4000;

/** States of runs with the same colour. */
const kRunStatus: Record<SweepPhase, string> = {
  flying: 'running',
  cancelling: 'cancelled',
  failed: 'failed',
  stopped: 'cancelled',
  'border found': 'completed',
  complete: 'completed',
};

/** What is asked twice. */
interface Question {
  sweep: string;
  action: 'cancel' | 'delete';
}

export class SweepHead {
  readonly root: HTMLElement;
  private readonly title = h('div', { class: 'sweep-title' });
  private readonly buttons = h('div', { class: 'sweep-buttons', 'data-changes': true });
  private readonly progress = h('div', { class: 'sweep-progress', 'data-role': 'sweep-progress' });
  /** Awaits the second click, which is no answer to another question in the same place. */
  private confirming: Question | null = null;
  private shown: SweepState | null = null;
  private all: readonly SweepEntry[] = [];

  constructor(private readonly context: Context) {
    this.root = h(
      'div',
      { class: 'sweep-head' },
      h('div', { class: 'sweep-top' }, this.title, this.buttons),
      this.progress,
    );
  }

  /** @param all  sweeps of the server */
  draw(shown: SweepState, all: readonly SweepEntry[]): void {
    this.shown = shown;
    this.all = all;
    this.drawTitle(shown);
    this.drawButtons(shown);
    this.drawProgress(shown);
  }

  private drawTitle({ sweep }: SweepState): void {
    const state = stateOf(sweep);
    rebuild(this.title, JSON.stringify([sweep.name, sweep.title, sweep.description, state]), () => [
      h(
        'h3',
        {},
        sweep.title === '' ? sweep.name : sweep.title,
        h(
          'span',
          { class: 'chip small', 'data-role': 'sweep-state', 'data-status': kRunStatus[state] },
          state,
        ),
      ),
      h('p', {}, sweep.description ?? ''),
    ]);
  }

  private drawButtons({ sweep, table }: SweepState): void {
    const asked = this.confirming?.sweep === sweep.name ? this.confirming.action : null;
    const other = this.all.find(({ here, name }) => here !== null && name !== sweep.name);
    const unfinished = sweep.progress === null || sweep.progress.passed < sweep.progress.most;
    const failed = table?.failed ?? 0;
    const passed = sweep.progress?.passed ?? null;
    const key = [sweep.name, sweep.flying, sweep.here, asked, other?.name ?? null, passed];
    rebuild(this.buttons, JSON.stringify([key, unfinished, failed]), () => {
      if (sweep.here !== null) return [this.cancelButton(sweep, asked === 'cancel')];
      if (sweep.flying) return [];
      const hint =
        other === undefined ? null : `${other.name} is flying: one sweep flies at a time`;
      return [
        ...(unfinished || failed > 0 ? [this.continueButton(sweep, unfinished, hint)] : []),
        h(
          'button',
          {
            class: 'secondary',
            'data-role': 'extend-sweep',
            'data-of': sweep.name,
            title:
              'Change the sweep, for example with more values or repeats, and fly what it lacks',
            onclick: () => void this.context.sweeps.form.openSweep(sweep.name),
          },
          'Extend',
        ),
        this.deleteButton(sweep, asked === 'delete'),
      ];
    });
  }

  private cancelButton({ name, here }: SweepEntry, asked: boolean): HTMLElement {
    const cancelling = here === 'cancelling';
    return h(
      'button',
      {
        class: asked && !cancelling ? 'secondary danger' : 'secondary',
        'data-role': 'cancel-sweep',
        'data-of': name,
        disabled: cancelling,
        title: asked
          ? 'Click again to end the flights in progress; results stay'
          : 'End the flights in progress; results stay, and the sweep can be continued',
        onclick: () => {
          if (asked) void this.context.sweeps.cancel(name);
          this.ask(asked ? null : { sweep: name, action: 'cancel' });
        },
      },
      cancelling ? 'Cancelling' : asked ? 'Cancel the sweep?' : 'Cancel',
    );
  }

  private continueButton(
    { name, envelope }: SweepEntry,
    unfinished: boolean,
    hint: string | null,
  ): HTMLElement {
    return h(
      'button',
      {
        class: 'primary',
        'data-role': 'continue-sweep',
        'data-of': name,
        disabled: hint !== null,
        title: hint ?? continueHint(envelope),
        onclick: () => void this.context.sweeps.continue(name),
      },
      !unfinished
        ? 'Fly failed flights again'
        : envelope?.found === true
          ? 'Fly the other cells'
          : 'Continue',
    );
  }

  private deleteButton({ name, progress }: SweepEntry, asked: boolean): HTMLElement {
    const flights =
      progress === null
        ? 'its flights'
        : `its ${progress.passed} ${progress.passed === 1 ? 'flight' : 'flights'}`;
    return h(
      'button',
      {
        class: asked ? 'secondary danger' : 'secondary',
        'data-role': 'delete-sweep',
        'data-of': name,
        title: asked
          ? `Click again to delete the sweep and ${flights} for good`
          : `Delete the sweep and ${flights}`,
        onclick: () => {
          if (asked) void this.context.sweeps.remove(name);
          this.ask(asked ? null : { sweep: name, action: 'delete' });
        },
      },
      asked ? 'Delete the sweep?' : 'Delete',
    );
  }

  private ask(question: Question | null): void {
    this.confirming = question;
    if (this.shown !== null) this.drawButtons(this.shown);
    if (question === null) return;
    window.setTimeout(() => {
      if (this.confirming === question) this.ask(null);
    }, kConfirm_ms);
  }

  private drawProgress(shown: SweepState): void {
    const { sweep } = shown;
    const { progress, problem } = sweep;
    const texts = progressTexts(shown);
    const share = progress === null || progress.most === 0 ? 0 : progress.passed / progress.most;
    rebuild(this.progress, JSON.stringify([texts, share, sweep.flying, problem]), () => [
      ...(sweep.flying
        ? [
            h('progress', {
              value: share,
              max: 1,
              'aria-label': 'Flights that are over',
              title: formatPercent(share, 0),
            }),
          ]
        : []),
      h('span', {}, texts.join(' · ')),
      ...(problem === null
        ? []
        : [h('span', { class: 'sweep-problem', 'data-role': 'sweep-problem' }, problem)]),
    ]);
  }
}

/** How far the sweep is, in words. */
export function progressTexts({ sweep, table }: SweepState): string[] {
  const { progress } = sweep;
  const texts: string[] = [];
  if (progress !== null) {
    const { passed, most } = progress;
    texts.push(passed < most ? `${passed} of ${most} flights` : `${most} flights`);
    if (sweep.flying && progress.left_s !== null && progress.left_s > 0) {
      texts.push(`about ${formatDuration(progress.left_s)} left`);
    }
    if (progress.spent_s > 0) texts.push(`${formatDuration(progress.spent_s)} flown`);
  }
  if (sweep.flying && sweep.here === null) texts.push('flown by another process');
  if (table === null) return [...texts, 'no flight is over yet'];
  if (table.failed > 0) {
    texts.push(table.failed === 1 ? '1 flight failed' : `${table.failed} flights failed`);
  }
  if (table.unreadable > 0) texts.push(`${table.unreadable} runs unreadable`);
  return [...texts, `last result ${formatDate(sweep.changed_utc)}`];
}

function continueHint(envelope: SweepEntry['envelope']): string {
  return envelope !== null && !envelope.found
    ? 'Look on for the border; failed flights are tried again'
    : 'Fly what the sweep lacks; failed flights are tried again';
}

export type SweepPhase =
  | 'flying'
  | 'cancelling'
  | 'failed'
  | 'stopped'
  | 'border found'
  | 'complete';

/** `stopped`: cancelled or killed before its end. */
export function stateOf({ flying, here, problem, progress, envelope }: SweepEntry): SweepPhase {
  if (here !== null) return here;
  if (flying) return 'flying';
  if (problem !== null) return 'failed';
  if (progress !== null && progress.passed >= progress.most) return 'complete';
  return envelope?.found === true ? 'border found' : 'stopped';
}

/** Title, state and progress in a line of the list. */
export function sweepDetail(sweep: SweepEntry): string {
  const { flying, progress } = sweep;
  const parts = [sweep.title];
  if (flying && progress !== null && progress.most > 0) {
    parts.push(`${stateOf(sweep)}, ${formatPercent(progress.passed / progress.most, 0)}`);
  } else {
    parts.push(stateOf(sweep), formatDate(sweep.changed_utc));
  }
  return parts.filter((part) => part !== '').join(' · ');
}
