// Edits what people write about a run: tags and a note.
import type { Run } from '../../protocol/rest_types';
import { knownTags, tagsFrom } from '../../store/runs/run_tags';
import { h } from '../dom';

const kTagList = 'known-tags';

/** @param save  called with the new tags and note */
export function notesForm(
  run: Run,
  runs: readonly Run[],
  save: (tags: string[], note: string) => void,
  close: () => void,
): HTMLElement {
  const tags = h('input', {
    type: 'text',
    value: run.tags.join(', '),
    list: kTagList,
    placeholder: 'Tags, with commas between',
    'aria-label': 'Tags, with commas between',
    'data-role': 'tags',
  });
  const note = h('textarea', {
    rows: 3,
    placeholder: 'Note',
    'aria-label': 'Note',
    'data-role': 'note',
    maxlength: 4000,
  });
  note.value = run.note;
  return h(
    'form',
    {
      class: 'notes-form',
      onsubmit: (event: SubmitEvent) => {
        event.preventDefault();
        save(tagsFrom(tags.value), note.value.trim());
      },
      onkeydown: (event: KeyboardEvent) => {
        if (event.key !== 'Escape') return;
        event.stopPropagation();
        close();
      },
    },
    h(
      'div',
      { class: 'notes-head' },
      h('span', { class: 'run-name' }, run.title || run.scenario),
      h('button', { type: 'button', onclick: close }, 'Cancel'),
      h('button', { type: 'submit', class: 'primary' }, 'Save'),
    ),
    h('datalist', { id: kTagList }, ...knownTags(runs).map((tag) => h('option', { value: tag }))),
    tags,
    note,
  );
}
