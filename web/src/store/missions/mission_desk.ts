// Draws missions: opens worlds, edits with undo, asks the server what they will be like, saves and
// flies them. The page computes nothing of a flight itself.
import type { RestClient } from '../../connection/rest_client';
import { errorText, fieldErrorsOf } from '../../connection/rest_error';
import type { JsonObject } from '../../protocol/rest_types';
import type { Storage } from '../layouts/layouts';
import type { Session } from '../session';
import type { Store } from '../state';
import {
  asFlown,
  fileNameOf,
  flightOf,
  freeName,
  kUsualFlight,
  missionDocument,
} from './mission_document';
import { drawnText, readDraft, writeDraft } from './mission_draft';
import { movedTo } from './mission_edit';
import { MissionEditor } from './mission_editor';
import type { MissionFile, MissionFormat, ReadableFile } from './mission_exchange';
import { readMissionFile, writeMissionFile } from './mission_exchange';
import type { MissionDraft, MissionPage } from './mission_page';
import { MissionReporter } from './mission_reporter';
import { MissionWorlds } from './mission_worlds';
import { emptyMission, missionFromPlan, notFlown } from './plan_file';

/** Gives a new mission its cameras and estimators. */
const kUsualBase = 'course';
const kUsualWorld = 'builtin:1';

export class MissionDesk extends MissionEditor {
  /** Counts the choices of a scenario: late answers about the one before are dropped. */
  private choices = 0;
  /** What is drawn, as the server had it when the mission was opened or saved; null = never. */
  private kept: string | null = null;
  private readonly worlds: MissionWorlds;
  private readonly reporter: MissionReporter;

  constructor(
    store: Store,
    private readonly rest: RestClient,
    private readonly session: Pick<Session, 'selectRun'>,
    private readonly storage: Storage,
    later: (callback: () => void, delay_ms: number) => void,
    private readonly newKey: () => string,
    /** Called when the server's scenarios have changed. */
    private readonly onScenarios: () => Promise<void>,
  ) {
    super(store);
    this.worlds = new MissionWorlds(store, rest, later, newKey);
    this.reporter = new MissionReporter(
      store,
      rest,
      later,
      () => this.document(),
      () => this.keepDraft(),
    );
  }

  async open(): Promise<void> {
    const { page } = this;
    this.store.state.openPage(page);
    // Before the first wait, so that nothing that is chosen meanwhile replaces it unasked.
    if (page.draft === null && !page.working) page.draft = readDraft(this.storage, this.newId);
    this.changed();
    await this.worlds.read();
    if (!page.working) await this.openRest();
    this.reporter.schedule();
  }

  /** Opens what is missing: a mission, or its world if the server was away before. */
  private async openRest(): Promise<void> {
    const { draft, world, making } = this.page;
    if (draft === null) await this.startNew();
    else if (world === null && making === null) await this.worlds.open(draft.world);
  }

  close(): void {
    this.reporter.cancel();
    this.page.open = false;
    this.changed();
  }

  // ---- worlds ----------------------------------------------------------------------------------

  /** Flies the mission over another world; a mission outside of it can be moved there. */
  async chooseWorld(name: string): Promise<void> {
    const { draft } = this.page;
    if (draft === null || draft.world === name) return;
    this.page.draft = { ...draft, world: name };
    this.history.clear();
    this.noteUndo();
    await this.worlds.open(name);
    this.settle();
  }

  /** Makes the draft's built-in world. */
  async makeWorld(): Promise<void> {
    const name = this.page.draft?.world;
    if (name === undefined) return;
    await this.worlds.make(name);
    this.settle();
  }

  /** An empty mission begins where the world suggests. */
  private settle(): void {
    const { draft, world } = this.page;
    if (draft !== null && world !== null && draft.mission.items.length === 0) {
      this.page.draft = { ...draft, mission: emptyMission(this.worlds.usualHome()) };
    }
    this.reporter.schedule();
  }

  /** Puts home, and everything with it, where the world suggests. */
  moveToWorld(): void {
    const { lat_deg, lon_deg } = this.worlds.usualHome();
    this.edit((mission) => movedTo(mission, [lat_deg, lon_deg]));
  }

  get isElsewhere(): boolean {
    return this.worlds.isElsewhere;
  }

  // ---- missions --------------------------------------------------------------------------------

  async startNew(): Promise<void> {
    const { scenarios } = this.store.state;
    const able = (scenarios ?? []).filter(({ error }) => error === null);
    const base = able.find(({ name }) => name === kUsualBase) ?? able[0];
    if (base === undefined) {
      this.page.notes = ['The server has no scenario that could give cameras and estimators.'];
      this.changed();
      return;
    }
    await this.begin(base.name, async (document, world) => {
      const draft: MissionDraft = {
        title: '',
        name: null,
        base: base.name,
        baseDocument: document,
        world,
        flight: { ...kUsualFlight },
        mission: emptyMission({ lat_deg: 0, lon_deg: 0, alt_msl_m: 0 }),
      };
      if (await this.show(draft)) this.settle();
    });
  }

  /** Opens the mission of a scenario. */
  async openScenario(name: string): Promise<void> {
    await this.begin(name, async (document, world, isCurrent) => {
      const plan = await this.rest.scenarioPlan(name);
      if (!isCurrent()) return;
      const mission = missionFromPlan(plan, this.newId);
      const own = this.store.state.scenarios?.find((entry) => entry.name === name)?.saved === true;
      const title = typeof document['title'] === 'string' ? document['title'] : name;
      const draft: MissionDraft = {
        title,
        name: own ? name : null,
        base: name,
        baseDocument: document,
        world,
        flight: flightOf(document),
        mission,
      };
      if (!(await this.show(draft))) return;
      const read = this.placeAsFlown(draft, document);
      this.page.notes = notFlown(mission);
      this.page.savedText = own ? JSON.stringify(this.documentOf(read)) : null;
      this.kept = drawnText(read);
    });
  }

  /**
   * Puts the present mission, which may have been edited meanwhile, where its scenario flies it.
   * @return the draft as it was read, at the same place
   */
  private placeAsFlown(read: MissionDraft, document: JsonObject): MissionDraft {
    const { draft, world } = this.page;
    if (draft === null || world?.name !== read.world) return read;
    const placed = (one: MissionDraft) => ({
      ...one,
      mission: asFlown(one.mission, document, world),
    });
    const present = placed(draft);
    if (present.mission !== draft.mission) {
      // Earlier states are at the other place.
      this.history.clear();
      this.noteUndo();
    }
    this.page.draft = present;
    return placed(read);
  }

  /** Takes cameras, estimators and the rest from another scenario. */
  async chooseBase(name: string): Promise<void> {
    await this.begin(name, (document) => {
      const { draft } = this.page;
      if (draft !== null) this.page.draft = { ...draft, base: name, baseDocument: document };
      this.page.camera = '';
      return Promise.resolve();
    });
  }

  /** @param work  asks after each wait whether its scenario is still the chosen one */
  private async begin(
    name: string,
    work: (document: JsonObject, world: string, isCurrent: () => boolean) => Promise<void>,
  ): Promise<void> {
    const { page } = this;
    this.choices += 1;
    const { choices } = this;
    const isCurrent = () => this.choices === choices;
    page.working = true;
    this.changed();
    try {
      const document = await this.rest.scenario(name);
      if (!isCurrent()) return;
      const world = page.worlds?.find(({ scenarios }) => scenarios.includes(name));
      await work(document, world?.name ?? kUsualWorld, isCurrent);
    } catch (error) {
      if (isCurrent()) page.notes = [`${name}: ${errorText(error)}`];
    }
    if (isCurrent()) page.working = false;
    this.reporter.schedule();
  }

  /** @return whether it is still shown when its world is open */
  private async show(draft: MissionDraft): Promise<boolean> {
    const { page } = this;
    page.opened += 1;
    const { opened } = page;
    page.draft = draft;
    page.selected = null;
    page.notes = [];
    page.camera = '';
    page.savedText = null;
    this.kept = drawnText(draft);
    this.history.clear();
    this.noteUndo();
    if (page.world?.name !== draft.world) await this.worlds.open(draft.world);
    return page.opened === opened;
  }

  // ---- what the mission will be like -----------------------------------------------------------

  /** Camera, limits and interval of the report. */
  setReport(change: Partial<Pick<MissionPage, 'camera' | 'limits' | 'overlapInterval_s'>>): void {
    Object.assign(this.page, change);
    this.reporter.schedule();
  }

  moveCursor(distance_m: number | null): void {
    if (this.page.cursor_m === distance_m) return;
    this.page.cursor_m = distance_m;
    this.store.change('missionCursor');
  }

  /** The scenario that the draft is; null while there is none. */
  document(): JsonObject | null {
    return this.documentOf(this.page.draft);
  }

  private documentOf(draft: MissionDraft | null): JsonObject | null {
    const world = this.page.worlds?.find(({ name }) => name === draft?.world);
    if (draft === null || world === undefined) return null;
    const document = missionDocument(
      draft.baseDocument,
      world.world,
      draft.title,
      draft.flight,
      draft.mission,
    );
    return { ...document, name: draft.name ?? fileNameOf(draft.title) };
  }

  // ---- keeping and flying ----------------------------------------------------------------------

  get isChanged(): boolean {
    return this.page.savedText !== this.draftText();
  }

  /** Whether it would be lost if another mission was opened. */
  get isUnsaved(): boolean {
    const { draft } = this.page;
    return draft !== null && draft.mission.items.length > 0 && drawnText(draft) !== this.kept;
  }

  private draftText(): string {
    return JSON.stringify(this.document());
  }

  /** In the browser, with the name under which it is saved: another name would replace another scenario. */
  private keepDraft(): void {
    writeDraft(this.storage, this.page.draft);
  }

  /** Saves the draft as a scenario. @param copy  under a new name */
  async save(copy = false): Promise<void> {
    const { page } = this;
    const { draft, opened } = page;
    if (draft === null || page.working) return;
    const replace = draft.name !== null && !copy;
    const name = replace
      ? (draft.name ?? '')
      : freeName(fileNameOf(draft.title), this.store.state.scenarios);
    const titled = (title: string) => (title.trim() === '' ? 'Mission' : title);
    const sent = this.documentOf({ ...draft, name, title: titled(draft.title) });
    if (sent === null) return;
    await this.work(async () => {
      await this.rest.saveScenario(name, sent, replace);
      // What was edited meanwhile stays; another mission may have been opened.
      if (page.draft !== null && page.opened === opened) {
        page.draft = { ...page.draft, name, title: titled(page.draft.title) };
        page.savedText = JSON.stringify(sent);
        this.kept = drawnText({ ...draft, title: titled(draft.title) });
        page.notes = [`Saved as ${name}.`];
        this.keepDraft();
      }
      await this.onScenarios();
      await this.worlds.read();
    });
  }

  /** Deletes a saved mission; the draft stays. */
  async removeScenario(name: string): Promise<void> {
    await this.work(async () => {
      await this.rest.deleteScenario(name);
      const { draft } = this.page;
      if (draft?.name === name) {
        this.page.draft = { ...draft, name: null };
        this.page.savedText = null;
        this.kept = null;
        this.keepDraft();
      }
      await this.onScenarios();
    });
  }

  async fly(): Promise<void> {
    const document = this.document();
    if (document === null) return;
    await this.work(async () => {
      const run = await this.rest.startDocument(document, this.newKey());
      const { state } = this.store;
      state.runs = [run, ...(state.runs ?? []).filter(({ id }) => id !== run.id)];
      this.session.selectRun(run.id);
      this.store.change('lists');
      this.close();
    });
  }

  private async work(action: () => Promise<void>): Promise<void> {
    const { page } = this;
    page.working = true;
    page.errors = [];
    this.changed();
    try {
      await action();
    } catch (error) {
      page.errors = fieldErrorsOf(error);
    }
    page.working = false;
    this.changed();
  }

  // ---- files of ground stations ----------------------------------------------------------------

  /** Replaces the mission by that of a file; what cannot be flown is kept and reported. */
  async import(file: ReadableFile): Promise<void> {
    const { page } = this;
    if (page.draft === null) return;
    try {
      const mission = await readMissionFile(file, this.newId);
      this.edit(() => mission);
      page.selected = null;
      page.notes = [`${file.name}: ${mission.items.length} items.`, ...notFlown(mission)];
    } catch (error) {
      page.notes = [`${file.name}: ${errorText(error)}`];
    }
    this.changed();
  }

  /** null without a mission; what the format cannot hold is noted. */
  export(format: MissionFormat): MissionFile | null {
    const { draft } = this.page;
    if (draft === null) return null;
    const { file, lost } = writeMissionFile(draft.mission, fileNameOf(draft.title), format);
    this.page.notes = lost.map((what) => `A .${format} file cannot hold ${what}.`);
    this.changed();
    return file;
  }

  protected override onEdit(): void {
    this.reporter.schedule();
  }
}
