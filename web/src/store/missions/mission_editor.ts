// Edits the mission of the page, with undo.
import type { Store } from '../state';
import { History } from './history';
import { changed, indexAfter, inserted, newItem, removed } from './mission_edit';
import type { Mission, SimpleItem } from './mission_item';
import type { MissionDraft, MissionPage } from './mission_page';

export abstract class MissionEditor {
  protected readonly history = new History<MissionDraft>();
  private nextId = 1;

  constructor(protected readonly store: Store) {}

  /** Called after each edit. */
  protected abstract onEdit(): void;

  /** @param kind  as of History.record */
  edit(change: (mission: Mission) => Mission, kind: string | null = null): void {
    const { draft } = this.page;
    if (draft === null) return;
    const mission = change(draft.mission);
    if (mission !== draft.mission) this.replace({ ...draft, mission }, kind);
  }

  editItem(id: number, change: (item: SimpleItem) => SimpleItem, kind: string | null = null): void {
    this.edit((mission) => changed(mission, id, change), kind);
  }

  /** Title and flight settings. */
  set(change: Partial<Pick<MissionDraft, 'title' | 'flight'>>, kind: string | null = null): void {
    const { draft } = this.page;
    if (draft !== null) this.replace({ ...draft, ...change }, kind);
  }

  /** Adds an item after the selected one, or at the end, and selects it. */
  add(command: number, place: readonly [number, number], index?: number): void {
    const { draft, selected } = this.page;
    if (draft === null) return;
    const id = this.newId();
    this.edit((mission) => {
      const at = index ?? indexAfter(mission, selected);
      return inserted(mission, at, newItem(mission, at, id, command, place));
    });
    this.select(id);
  }

  remove(id: number): void {
    const { draft } = this.page;
    const index = draft?.mission.items.findIndex((item) => item.id === id) ?? -1;
    this.edit((mission) => removed(mission, id));
    const items = this.page.draft?.mission.items ?? [];
    this.select(items[Math.min(index, items.length - 1)]?.id ?? null);
  }

  select(id: number | null): void {
    if (this.page.selected === id) return;
    this.page.selected = id;
    this.changed();
  }

  undo(): void {
    this.restore(this.page.draft === null ? null : this.history.undo(this.page.draft));
  }

  redo(): void {
    this.restore(this.page.draft === null ? null : this.history.redo(this.page.draft));
  }

  /** What is not drawn stays: the saved scenario, the one that gives the rest, and the world. */
  private restore(draft: MissionDraft | null): void {
    const present = this.page.draft;
    if (draft === null || present === null) return;
    const { name, base, baseDocument, world } = present;
    this.page.draft = { ...draft, name, base, baseDocument, world };
    this.noteUndo();
    this.onEdit();
  }

  private replace(draft: MissionDraft, kind: string | null): void {
    if (this.page.draft !== null) this.history.record(this.page.draft, kind);
    this.page.draft = draft;
    this.noteUndo();
    this.onEdit();
  }

  protected noteUndo(): void {
    this.page.canUndo = this.history.canUndo;
    this.page.canRedo = this.history.canRedo;
  }

  protected readonly newId = () => this.nextId++;

  protected get page(): MissionPage {
    return this.store.state.missionPage;
  }

  protected changed(): void {
    this.store.change('missions');
  }
}
