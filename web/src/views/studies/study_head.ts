// Title, state and progress of a study, and the buttons that cancel, continue and delete it.
import type { StudyEntry, StudyState } from '../../protocol/study_types';
import { isOpen } from '../../protocol/study_types';
import { formatPercent } from '../../store/format';
import { progressTexts } from '../../store/studies/study_words';
import { h, rebuild } from '../dom';
import type { Context } from '../view';

const kConfirm_ms = 4000;

/** States of runs with the same colour. */
const kRunStatus: Record<StudyState, string> = {
  waiting: 'queued',
  running: 'running',
  done: 'completed',
  failed: 'failed',
  cancelled: 'cancelled',
  interrupted: 'cancelled',
};

export class StudyHead {
  readonly root: HTMLElement;
  private readonly title = h('div', { class: 'sweep-title' });
  private readonly buttons = h('div', { class: 'sweep-buttons', 'data-changes': true });
  private readonly progress = h('div', { class: 'sweep-progress', 'data-role': 'study-progress' });
  /** The study whose deletion awaits confirmation. */
  private confirming: string | null = null;
  private shown: StudyEntry | null = null;

  constructor(private readonly context: Context) {
    this.root = h(
      'div',
      { class: 'sweep-head' },
      h('div', { class: 'sweep-top' }, this.title, this.buttons),
      this.progress,
    );
  }

  draw(study: StudyEntry): void {
    this.shown = study;
    const { title, state, cancelling, subject, kind } = study;
    rebuild(this.title, JSON.stringify([title, state, cancelling, subject]), () => [
      h(
        'h3',
        {},
        title,
        h(
          'span',
          { class: 'chip small', 'data-role': 'study-state', 'data-status': kRunStatus[state] },
          cancelling ? 'cancelling' : state,
        ),
      ),
      h('p', {}, `${kind === 'explain' ? 'Run' : 'Scenario'} ${subject}`),
    ]);
    this.drawButtons(study);
    this.drawProgress(study);
  }

  private drawButtons(study: StudyEntry): void {
    const { name, cancelling } = study;
    const { studies } = this.context;
    const asked = this.confirming === name;
    rebuild(this.buttons, JSON.stringify([name, study.state, cancelling, asked]), () => {
      if (isOpen(study)) {
        return [
          h(
            'button',
            {
              class: 'secondary',
              'data-role': 'cancel-study',
              'data-of': name,
              disabled: cancelling,
              title: 'End it; what it has found stays, and it can be continued',
              onclick: () => void studies.cancel(name),
            },
            cancelling ? 'Cancelling' : 'Cancel',
          ),
        ];
      }
      const go_on =
        study.state === 'done'
          ? []
          : [
              h(
                'button',
                {
                  class: 'primary',
                  'data-role': 'continue-study',
                  'data-of': name,
                  title: 'Make it again; completed flights are not flown twice',
                  onclick: () => void studies.continue(name),
                },
                'Continue',
              ),
            ];
      return [...go_on, this.deleteButton(name, asked)];
    });
  }

  private deleteButton(name: string, asked: boolean): HTMLElement {
    return h(
      'button',
      {
        class: asked ? 'secondary danger' : 'secondary',
        'data-role': 'delete-study',
        'data-of': name,
        title: asked
          ? 'Click again to delete the study and its flights for good'
          : 'Delete the study and its flights',
        onclick: () => {
          if (asked) void this.context.studies.remove(name);
          this.ask(asked ? null : name);
        },
      },
      asked ? 'Delete the study?' : 'Delete',
    );
  }

  private ask(name: string | null): void {
    this.confirming = name;
    if (this.shown !== null) this.drawButtons(this.shown);
    if (name === null) return;
    window.setTimeout(() => {
      if (this.confirming === name) this.ask(null);
    }, kConfirm_ms);
  }

  private drawProgress(study: StudyEntry): void {
    const { progress, problem } = study;
    const texts = progressTexts(study);
    rebuild(this.progress, JSON.stringify([texts, progress?.share, problem]), () => [
      ...(progress === null
        ? []
        : [
            h('progress', {
              value: progress.share,
              max: 1,
              'aria-label': 'Share of the study that is done',
              title: formatPercent(progress.share, 0),
            }),
          ]),
      h('span', {}, texts.join(' · ')),
      ...(problem === null
        ? []
        : [h('span', { class: 'sweep-problem', 'data-role': 'study-problem' }, problem)]),
    ]);
  }
}
