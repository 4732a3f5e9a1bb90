// Scenarios and runs of the server: listed, launched, cancelled and deleted over REST.
import type { RestClient } from '../connection/rest_client';
import { errorText, fieldErrorsOf, isPassing } from '../connection/rest_error';
import type { JsonObject, Run, ScenarioEntry } from '../protocol/rest_types';
import { isActive } from '../protocol/rest_types';
import type { Notices } from './notices';
import { withNewer } from './runs/newer_runs';
import { SilentRuns } from './runs/silent_runs';
import type { ShownScenario } from './scenario/draft';
import {
  draftOf,
  kChangedMeanwhile,
  kChosenMeanwhile,
  overridesBetween,
  sameJson,
} from './scenario/draft';
import { KeptEdits } from './scenario/kept_edits';
import { documentErrors } from './scenario/schema_check';
import type { Session } from './session';
import type { Store } from './state';
import type { StudyScenario } from './studies/study_form';

/** Selected first, because it needs no data. */
const kPreferred = 'course';
const kPollActive_ms = 1500;
const kPollIdle_ms = 8000;

export class Catalogue {
  private polling = false;
  /** Ids of the runs that were over in the last list; the stream changes those of the state. */
  private over: ReadonlySet<string> = new Set();
  private readonly silent: SilentRuns;
  private reading: Promise<void> = Promise.resolve();
  /** Number of the latest choice in the launcher: a scenario, or a run that is flown again. */
  private choice = 0;
  private readonly kept = new KeptEdits();
  /** Number of the latest choice of a scenario. */
  private selection = 0;
  /** Number of a choice whose scenario could not be read because the server was away or busy. */
  private unread: number | null = null;

  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
    private readonly session: Session,
    private readonly notices: Notices,
    private readonly later: (callback: () => void, delay_ms: number) => void,
    private readonly newKey: () => string,
  ) {
    this.silent = new SilentRuns(session);
  }

  /**
   * Reads the scenarios once, and the runs periodically.
   * @param showNewest  shows the newest run once the list is read, unless one is shown already
   */
  start(showNewest: boolean): void {
    void this.readScenarios();
    void this.poll().then(() => {
      const { runs, watched } = this.store.state;
      const newest = runs?.[0];
      if (showNewest && watched.length === 0 && newest !== undefined) {
        this.session.selectRun(newest.id);
      }
    });
  }

  async readScenarios(): Promise<void> {
    const { state } = this.store;
    try {
      state.scenarios = await this.rest.scenarios();
      state.listError = null;
    } catch (error) {
      state.listError = errorText(error);
      this.store.change('lists');
      return;
    }
    this.store.change('lists');
    this.leaveDeleted(state.scenarios);
    const flyable = state.scenarios.filter(({ error }) => error === null);
    const first = flyable.find(({ name }) => name === kPreferred) ?? flyable[0];
    if (state.scenarioName !== null && this.isUnread) {
      await this.selectScenario(state.scenarioName);
    } else if (state.scenarioName !== null) await this.readAgain(state.scenarioName);
    else if (first !== undefined) await this.selectScenario(first.name);
  }

  private get isUnread(): boolean {
    return this.unread === this.choice;
  }

  /** Somebody may have deleted the scenario that the launcher shows. */
  private leaveDeleted(scenarios: readonly ScenarioEntry[]): void {
    const { state } = this.store;
    const { scenarioName, repeatedRun } = state;
    if (scenarioName === null || repeatedRun !== null) return;
    if (scenarios.some(({ name }) => name === scenarioName)) return;
    this.notices.error(`The scenario ${scenarioName} is no longer on the server.`);
    this.leaveChanges();
    Object.assign(state, { scenarioName: null, scenarioDocument: null });
    this.store.change('launch');
  }

  /** Another page, or another browser, may have saved the scenario that the launcher shows. */
  private async readAgain(name: string): Promise<void> {
    const { state } = this.store;
    const { choice } = this;
    if (state.repeatedRun !== null || state.scenarioDocument === null) return;
    let document: JsonObject;
    try {
      document = await this.rest.scenario(name);
    } catch {
      return; // The next reading of the list repeats it.
    }
    if (this.choice !== choice || state.scenarioName !== name) return;
    const changed = !sameJson(document, state.scenarioDocument);
    if (!changed && !state.scenarioChanged) return;
    state.scenarioChanged = changed && state.scenarioEdits.size > 0;
    state.launchErrors = state.launchErrors.filter((error) => error !== kChangedMeanwhile);
    if (state.scenarioChanged) state.launchErrors.push(kChangedMeanwhile);
    else state.scenarioDocument = document;
    this.store.change('launch');
  }

  async selectScenario(name: string): Promise<void> {
    const { state } = this.store;
    const selection = ++this.choice;
    this.selection = selection;
    // A run that is flown again replaces it once its scenario is read, not if that fails.
    const isCurrent = () =>
      this.selection === selection && state.scenarioName === name && state.repeatedRun === null;
    this.leaveChanges();
    state.scenarioName = name;
    state.repeatedRun = null;
    state.scenarioDocument = null;
    this.store.change('launch');
    const entry = state.scenarios?.find((scenario) => scenario.name === name);
    if (entry !== undefined && entry.error !== null) {
      state.launchErrors = [{ field: '', message: entry.error }];
      this.store.change('launch');
      return;
    }
    try {
      const document = await this.rest.scenario(name);
      if (!isCurrent()) return;
      state.scenarioDocument = document;
      this.restoreChanges();
    } catch (error) {
      if (!isCurrent()) return;
      state.launchErrors = [{ field: '', message: errorText(error) }];
      if (isPassing(error)) this.unread = selection;
    }
    this.store.change('launch');
  }

  /** Shows in the form what a run flew, to fly it again with changes. */
  async repeat(run: Run): Promise<void> {
    const { state } = this.store;
    const choice = ++this.choice;
    let document: JsonObject;
    try {
      document = await this.rest.runScenario(run.id);
    } catch (error) {
      if (this.choice === choice) this.notices.error(errorText(error));
      return;
    }
    if (this.choice !== choice) return;
    this.leaveChanges();
    // Pages that need a scenario's name go on with the same one.
    if (state.scenarios?.some(({ name }) => name === run.scenario) === true) {
      state.scenarioName = run.scenario;
    }
    state.repeatedRun = run;
    state.scenarioDocument = document;
    this.restoreChanges();
    this.store.change('launch');
  }

  /** They are shown again when the same scenario, or run, is chosen again. */
  private leaveChanges(): void {
    const { state } = this.store;
    this.kept.keep(state);
    state.scenarioEdits = new Map();
    state.scenarioChanged = false;
    state.launchErrors = [];
    state.scenarioEditor.check = 'none';
  }

  private restoreChanges(): void {
    if (this.kept.restore(this.store.state)) return;
    this.notices.error('The scenario was changed on the server: your changes of it are not kept.');
  }

  /**
   * Looks whether the server still has the scenario that the launcher shows: somebody else may have
   * saved it. If so, the launcher shows the new one, or that it is not that of the changes.
   */
  async lookAgain(): Promise<ShownScenario> {
    const { state } = this.store;
    const { choice } = this;
    const { scenarioDocument: shown, scenarioName: name } = state;
    if (name !== null) await this.readAgain(name);
    if (this.choice !== choice || state.scenarioName !== name) return 'left';
    if (state.scenarioChanged) return 'changed';
    if (state.scenarioDocument === shown) return 'same';
    this.notices.error('The scenario was changed on the server: Launch shows the new one.');
    return 'changed';
  }

  /** Starts a run of the changed scenario and watches it. @return whether it was started */
  async launch(): Promise<boolean> {
    const { state } = this.store;
    const document = this.checkedDocument();
    if (state.launching || document === null) return false;
    state.launching = true;
    const { choice } = this;
    // The server checks it now: an earlier check does not answer any more.
    state.scenarioEdits = new Map(state.scenarioEdits);
    state.scenarioEditor.check = state.scenarioEdits.size === 0 ? 'none' : 'done';
    this.store.change('launch');
    let started = false;
    try {
      const found = await this.lookAgain();
      if (found === 'left') this.notices.error(`Nothing was flown: ${kChosenMeanwhile}`);
      if (found === 'same') {
        const run = await this.fly(document);
        state.runs = [run, ...(state.runs ?? []).filter(({ id }) => id !== run.id)];
        this.session.selectRun(run.id);
        started = true;
      }
    } catch (error) {
      // They are about the scenario that was shown then.
      if (this.choice === choice) state.launchErrors = fieldErrorsOf(error);
      else this.notices.error(`Nothing was flown: ${errorText(error)}`);
    }
    state.launching = false;
    this.store.change('launch', 'lists');
    return started;
  }

  /** The changed scenario, for a study; null, with its errors shown, if it has any. */
  asked(): StudyScenario | null {
    const { repeatedRun, scenarioDocument, scenarioName, scenarios } = this.store.state;
    const document = this.checkedDocument();
    if (scenarioDocument === null || document === null) return null;
    const overrides = overridesBetween(scenarioDocument, document);
    const entry = scenarios?.find(({ name }) => name === scenarioName);
    const scenario = scenarioName ?? '';
    if (repeatedRun === null && overrides !== null) {
      return { scenario, overrides, document: null, title: entry?.title ?? scenario };
    }
    const title =
      repeatedRun === null
        ? (entry?.title ?? scenario)
        : `Again: ${repeatedRun.title || repeatedRun.scenario}`;
    return { scenario: '', overrides: {}, document, title };
  }

  /** The changed scenario; null, with its errors shown, if it has any. */
  private checkedDocument(): JsonObject | null {
    const { state } = this.store;
    const { scenarioDocument, scenarioEdits, scenarioSchema } = state;
    if (scenarioDocument === null) return null;
    const { document, errors } = draftOf(scenarioDocument, scenarioEdits);
    if (scenarioSchema !== null) errors.push(...documentErrors(scenarioSchema, document));
    if (state.scenarioChanged) errors.push(kChangedMeanwhile);
    state.launchErrors = errors;
    this.store.change('launch');
    return errors.length > 0 ? null : document;
  }

  private fly(document: JsonObject): Promise<Run> {
    const { repeatedRun, scenarioDocument, scenarioName } = this.store.state;
    const overrides = overridesBetween(scenarioDocument ?? {}, document);
    return repeatedRun === null && overrides !== null
      ? this.rest.startRun(scenarioName ?? '', overrides, this.newKey())
      : this.rest.startDocument(document, this.newKey());
  }

  async cancel(id: string): Promise<void> {
    await this.attempt(() => this.rest.cancelRun(id));
  }

  /** Replaces what people wrote about a run. @return whether the server took it */
  async setNotes(id: string, tags: readonly string[], note: string): Promise<boolean> {
    let taken = false;
    await this.attempt(async () => {
      await this.rest.setNotes(id, tags, note);
      taken = true;
    });
    return taken;
  }

  async remove(id: string): Promise<void> {
    await this.attempt(async () => {
      await this.rest.deleteRun(id);
      this.session.removeRun(id);
    });
  }

  private async attempt(action: () => Promise<void>): Promise<void> {
    try {
      await action();
    } catch (error) {
      this.notices.error(errorText(error));
    }
    await this.readRuns();
  }

  /** One list after another: an older one never replaces a newer one. */
  readRuns(): Promise<void> {
    this.reading = this.reading.then(() => this.readNextRuns());
    return this.reading;
  }

  private async readNextRuns(): Promise<void> {
    const { state } = this.store;
    const before = [...(state.runs ?? [])];
    try {
      const listed = await this.rest.runs();
      const now = state.runs ?? [];
      this.announceEnded(now, listed);
      state.runs = withNewer(listed, before, now);
      state.listError = null;
      this.silent.beginList();
      for (const run of listed) this.takeListed(run);
      this.announceDeleted(before, listed);
      if (state.scenarios === null || this.isUnread) await this.readScenarios();
    } catch (error) {
      state.listError = errorText(error);
    }
    this.store.change('lists');
  }

  /**
   * What the stream does not send about a watched run: its results, tags and note, and that another
   * process flies it on.
   */
  private takeListed(listed: Run): void {
    const watched = this.store.state.watchedRun(listed.id);
    if (watched === undefined) return;
    this.silent.take(listed, watched.run ?? listed);
    const { results, tags, note } = listed;
    const run = watched.run === null ? listed : { ...watched.run, results, tags, note };
    if (JSON.stringify(run) === JSON.stringify(watched.run)) return;
    watched.run = run;
    this.store.change('run');
  }

  /** Says which known runs ended; those that the viewer stopped are not announced. */
  private announceEnded(before: readonly Run[], now: readonly Run[]): void {
    const known = new Set(before.map(({ id }) => id).filter((id) => !this.over.has(id)));
    this.over = new Set(now.filter((run) => !isActive(run)).map(({ id }) => id));
    for (const run of now) {
      if (!known.has(run.id)) continue;
      const name = run.title || run.scenario;
      if (run.status === 'completed') this.notices.info(`${name}: the flight is complete.`);
      if (run.status === 'failed') {
        this.notices.error(`${name}: the flight failed. ${run.error ?? ''}`.trim());
      }
    }
  }

  /** Says which watched runs somebody else deleted; runs of sweeps and studies are in no list. */
  private announceDeleted(before: readonly Run[], now: readonly Run[]): void {
    for (const run of before) {
      const watched = this.store.state.watchedRun(run.id);
      if (watched === undefined || now.some(({ id }) => id === run.id)) continue;
      watched.deleted = true;
      const name = run.title || run.scenario;
      this.notices.error(
        `${name} (${run.id}) was deleted from the server. It is shown as far as it was read.`,
      );
      this.store.change('run');
    }
  }

  private async poll(): Promise<void> {
    if (this.polling) return;
    this.polling = true;
    await this.readRuns();
    this.polling = false;
    if (this.store.state.connection.status === 'locked') return;
    const active =
      this.store.state.runs?.some((run) => isActive(run) || !this.over.has(run.id)) === true;
    const failing = this.store.state.listError !== null;
    const soon = active || failing || this.silent.any;
    this.later(() => void this.poll(), soon ? kPollActive_ms : kPollIdle_ms);
  }
}
