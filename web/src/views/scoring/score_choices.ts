// The list of trajectories: one is the truth, the others may be ticked. Files can be dropped on it.
import type { TrajectoryChoice } from '../../store/scoring/score_desk';
import { choiceGroups } from '../../store/scoring/score_desk';
import { deleteButton } from '../delete_button';
import { h, rebuild, setText } from '../dom';
import type { Context } from '../view';

export class ScoreChoices {
  readonly root: HTMLElement;
  private readonly list = h('div', { class: 'score-groups' });
  private readonly note = h('div', { class: 'log-note' });
  private readonly search = h('input', {
    type: 'search',
    class: 'score-search',
    placeholder: 'Search',
    'aria-label': 'Search the trajectories',
  });
  private readonly file = h('input', {
    type: 'file',
    multiple: true,
    hidden: true,
    'data-role': 'score-file',
  });

  constructor(private readonly context: Context) {
    const { scores } = context;
    this.file.addEventListener('change', () => {
      void scores.send([...(this.file.files ?? [])]).then(() => (this.file.value = ''));
    });
    this.search.addEventListener('input', () => this.update());
    this.root = h(
      'div',
      { class: 'score-choices' },
      h(
        'div',
        { class: 'score-columns' },
        h('span', {}, 'Truth'),
        h('span', {}, 'Plot'),
        this.search,
      ),
      this.list,
      this.note,
      h(
        'button',
        {
          class: 'secondary',
          'data-role': 'upload-scores',
          'data-changes': true,
          title:
            'Trajectories (TUM, KITTI together with its times.txt, EuRoC, CSV) and flight logs; they can be dropped here, too',
          onclick: () => this.file.click(),
        },
        'Upload files',
      ),
      this.file,
    );
  }

  update(): void {
    const { scorePage, runs } = this.context.store.state;
    const { truth, estimates, files, listError, upload } = scorePage;
    const words = this.search.value.toLowerCase().split(/\s+/);
    const groups = choiceGroups(scorePage, runs).map(({ title, choices }) => ({
      title,
      choices: choices.filter(({ name, label }) => {
        const text = `${title} ${name} ${label}`.toLowerCase();
        return words.every((word) => text.includes(word));
      }),
    }));
    rebuild(this.list, JSON.stringify([groups, truth, estimates]), () =>
      groups.flatMap(({ title, choices }) =>
        choices.length === 0
          ? []
          : [
              h('h3', { title }, title),
              h('ul', {}, ...choices.map((choice) => this.entry(choice))),
            ],
      ),
    );
    setText(this.note, noteText(listError, files === null, files?.complete === false, upload));
  }

  private entry(choice: TrajectoryChoice): HTMLElement {
    const { scores, store } = this.context;
    const { truth, estimates } = store.state.scorePage;
    const { name, label, detail, uploaded } = choice;
    const radio = h('input', {
      type: 'radio',
      name: 'score-truth',
      'aria-label': `Truth: ${label}`,
      onchange: () => void scores.chooseTruth(name),
    });
    const box = h('input', {
      type: 'checkbox',
      'aria-label': `Score ${label}`,
      onchange: () => void scores.toggle(name),
    });
    radio.checked = truth === name;
    box.checked = estimates.includes(name);
    return h(
      'li',
      { 'data-trajectory': name },
      radio,
      box,
      h('span', { class: 'score-label', title: name }, label),
      h('span', { class: 'unit' }, detail),
      uploaded ? deleteButton(label, 'this file', () => void scores.remove(name)) : null,
    );
  }
}

function noteText(
  error: string | null,
  reading: boolean,
  cut: boolean,
  upload: { name: string; share: number } | null,
): string {
  if (error !== null) return error;
  if (upload !== null) return `Uploading ${upload.name}: ${Math.round(upload.share * 100)} %`;
  if (reading) return 'Reading the list';
  return cut ? 'There are more files than the list shows.' : '';
}
