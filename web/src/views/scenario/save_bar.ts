// Saves the scenario under a name, after a question if one of that name is replaced; deletes it.
import { freeName } from '../../store/missions/mission_document';
import type { State } from '../../store/state';
import { h, setText } from '../dom';
import type { Context } from '../view';

const kConfirm_ms = 3000;

export class SaveBar {
  readonly root: HTMLElement;
  private readonly name = h('input', {
    id: 'save-name',
    type: 'text',
    maxlength: 64,
    autocomplete: 'off',
    spellcheck: 'false',
  });
  private readonly save = h('button', { class: 'secondary', type: 'submit' }, 'Save');
  private readonly replace = h(
    'button',
    { class: 'secondary danger', type: 'button', 'data-role': 'replace-scenario', hidden: true },
    'Replace',
  );
  private readonly remove = h(
    'button',
    { class: 'secondary', type: 'button', 'data-role': 'delete-scenario', hidden: true },
    'Delete',
  );
  private readonly note = h('span', {
    class: 'save-note',
    role: 'status',
    'data-role': 'save-note',
  });
  /** The scenario for which the name was proposed. */
  private proposedFor: string | null = null;
  private confirming = false;

  constructor(private readonly context: Context) {
    const { scenarios } = context;
    this.name.addEventListener('input', () => scenarios.clearSave());
    this.replace.addEventListener('click', () => void scenarios.save(this.name.value.trim(), true));
    this.remove.addEventListener('click', () => this.askToDelete());
    this.root = h(
      'form',
      {
        class: 'save-bar',
        'data-changes': true,
        novalidate: true,
        onsubmit: (event: SubmitEvent) => {
          event.preventDefault();
          void scenarios.save(this.name.value.trim(), false);
        },
      },
      h('label', { for: 'save-name' }, 'Save as'),
      this.name,
      this.save,
      this.replace,
      this.remove,
      this.note,
    );
  }

  show({ scenarioEditor, scenarioName, scenarios, repeatedRun }: State): void {
    const { saving, saveError, replaces } = scenarioEditor;
    const entry = scenarios?.find(({ name }) => name === scenarioName);
    const own = repeatedRun === null && entry?.saved === true;
    const shown = `${repeatedRun?.id ?? ''}/${scenarioName ?? ''}`;
    if (this.proposedFor !== shown) {
      this.proposedFor = shown;
      this.name.value = own ? entry.name : freeName(entry?.name ?? 'scenario', scenarios ?? []);
    }
    this.save.disabled = saving;
    setText(this.save, saving ? 'Saving' : 'Save');
    this.replace.hidden = replaces === null;
    this.remove.hidden = !own || replaces !== null;
    setText(this.remove, this.confirming ? 'Delete?' : 'Delete');
    const question = replaces === null ? '' : `${replaces} exists already.`;
    setText(this.note, saveError === '' ? question : saveError);
    this.note.title = saveError;
    this.note.classList.toggle('bad', saveError !== '');
  }

  private askToDelete(): void {
    const { scenarios, store } = this.context;
    const name = store.state.scenarioName;
    if (this.confirming && name !== null) void scenarios.remove(name);
    this.confirming = !this.confirming;
    setText(this.remove, this.confirming ? 'Delete?' : 'Delete');
    if (!this.confirming) return;
    window.setTimeout(() => {
      this.confirming = false;
      setText(this.remove, 'Delete');
    }, kConfirm_ms);
  }
}
