// The bar of the page of missions: title, files, save, fly.
import { kNewMission, MissionChoice } from '../../store/missions/mission_choice';
import type { MissionFile, MissionFormat } from '../../store/missions/mission_exchange';
import type { MissionPage } from '../../store/missions/mission_page';
import { viewerNote } from '../access';
import { h, rebuild, setText } from '../dom';
import type { Context } from '../view';

export class MissionBar {
  readonly root: HTMLElement;
  private readonly title = h('input', {
    id: 'mission-title',
    type: 'text',
    maxlength: 120,
    placeholder: 'Name of the mission',
    'aria-label': 'Name of the mission',
    autocomplete: 'off',
  });
  private readonly opener = h('select', {
    id: 'mission-open',
    'aria-label': 'Open a mission',
    title: 'Missions of the server and saved ones',
  });
  private readonly undo = this.button('Undo', 'undo', 'Undo (Ctrl Z)', () =>
    this.context.missions.undo(),
  );
  private readonly redo = this.button('Redo', 'redo', 'Redo (Ctrl Y)', () =>
    this.context.missions.redo(),
  );
  private readonly save = this.button(
    'Save',
    'save',
    'Save as a scenario of the server (Ctrl S)',
    () => void this.context.missions.save(),
    true,
  );
  private readonly copy = this.button(
    'Save a copy',
    'save-copy',
    'Save under a new name',
    () => void this.context.missions.save(true),
    true,
  );
  private readonly remove = this.button(
    'Delete',
    'delete',
    'Delete the saved mission',
    () => this.askToDelete(),
    true,
  );
  private readonly fly = h(
    'button',
    {
      class: 'primary',
      'data-role': 'mission-fly',
      'data-changes': true,
      onclick: () => void this.context.missions.fly(),
    },
    'Fly',
  );
  private readonly file = h('input', {
    type: 'file',
    hidden: true,
    accept: '.plan,.waypoints,.txt,.json',
    'data-role': 'mission-file',
  });
  private readonly exporter = h(
    'select',
    {
      'aria-label': 'Export',
      'data-role': 'mission-export',
      title: 'Save a file for a ground station',
    },
    h('option', { value: '' }, 'Export'),
    h('option', { value: 'plan' }, 'QGroundControl (.plan)'),
    h('option', { value: 'waypoints' }, 'QGC WPL 110 (.waypoints)'),
  );
  private readonly notes = h('div', {
    class: 'mission-notes',
    role: 'status',
    'data-role': 'mission-notes',
  });
  private confirming = false;

  constructor(private readonly context: Context) {
    const { missions, store } = context;
    const choice = new MissionChoice(store, missions, (callback, delay_ms) => {
      window.setTimeout(callback, delay_ms);
    });
    this.title.addEventListener('input', () => missions.set({ title: this.title.value }, 'title'));
    this.opener.addEventListener('change', () => {
      const name = this.opener.value;
      this.opener.value = '';
      if (name !== '') void choice.choose(name);
    });
    this.file.addEventListener('change', () => {
      const [file] = this.file.files ?? [];
      if (file !== undefined) void missions.import(file);
      this.file.value = '';
    });
    this.exporter.addEventListener('change', () => {
      const file = missions.export(this.exporter.value as MissionFormat);
      this.exporter.value = '';
      if (file !== null) download(file);
    });
    this.root = h(
      'header',
      { class: 'mission-bar' },
      h('h2', {}, 'Missions'),
      this.title,
      this.opener,
      this.save,
      this.copy,
      this.remove,
      h('span', { class: 'divider' }),
      this.button('Import', 'import', 'Open a .plan or .waypoints file', () => this.file.click()),
      this.file,
      this.exporter,
      h('span', { class: 'divider' }),
      this.undo,
      this.redo,
      this.notes,
      viewerNote("Saving and flying need the operator's address."),
      this.fly,
      h(
        'button',
        {
          class: 'icon-button',
          'aria-label': 'Close',
          title: 'Close (Esc)',
          onclick: () => missions.close(),
        },
        '×',
      ),
    );
  }

  show(page: MissionPage): void {
    const { draft, working, canUndo, canRedo, notes, report } = page;
    const { missions, store } = this.context;
    if (document.activeElement !== this.title) this.title.value = draft?.title ?? '';
    this.title.disabled = draft === null;
    this.undo.disabled = !canUndo;
    this.redo.disabled = !canRedo;
    const empty = draft === null || draft.mission.items.length === 0;
    const changed = draft !== null && missions.isChanged;
    this.save.disabled = empty || working || !changed;
    setText(this.save, draft?.name !== null && !changed ? 'Saved' : 'Save');
    this.copy.disabled = empty || working || draft.name === null;
    this.remove.hidden = (draft?.name ?? null) === null;
    setText(this.remove, this.confirming ? 'Delete?' : 'Delete');
    this.fly.disabled = empty || working || report === null;
    this.exporter.disabled = empty;
    const known = (store.state.scenarios ?? []).filter(
      ({ flight, error }) => flight === 'mission' && error === null,
    );
    rebuild(this.opener, JSON.stringify(known), () => [
      h('option', { value: '' }, 'Open'),
      h('option', { value: kNewMission }, 'New mission'),
      ...known.map(({ name, title, saved }) =>
        h('option', { value: name }, saved ? title : `${title} (server)`),
      ),
    ]);
    setText(this.notes, notes.join(' · '));
    this.notes.title = notes.join('\n');
  }

  private askToDelete(): void {
    const { missions, store } = this.context;
    const name = store.state.missionPage.draft?.name ?? null;
    if (this.confirming && name !== null) void missions.removeScenario(name);
    this.confirming = !this.confirming;
    setText(this.remove, this.confirming ? 'Delete?' : 'Delete');
    if (!this.confirming) return;
    window.setTimeout(() => {
      this.confirming = false;
      setText(this.remove, 'Delete');
    }, 3000);
  }

  /** @param changes  it changes something on the server */
  private button(
    label: string,
    role: string,
    title: string,
    run: () => void,
    changes = false,
  ): HTMLButtonElement {
    return h(
      'button',
      {
        class: 'secondary',
        title,
        'data-role': `mission-${role}`,
        'data-changes': changes,
        onclick: run,
      },
      label,
    );
  }
}

function download({ name, text }: MissionFile): void {
  const address = URL.createObjectURL(new Blob([text], { type: 'application/octet-stream' }));
  h('a', { href: address, download: name }).click();
  URL.revokeObjectURL(address);
}
