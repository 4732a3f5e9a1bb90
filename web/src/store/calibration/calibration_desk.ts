// Runs a calibration on the server and follows it. The page computes nothing of the camera itself.
import type { CalibrationClient, SessionControl } from '../../connection/calibration_client';
import { errorText, RestError } from '../../connection/rest_error';
import type { CalibrationSession } from '../../protocol/calibration_types';
import type { JsonObject } from '../../protocol/rest_types';
import type { Notices } from '../notices';
import type { Store } from '../state';
import type { CalibrationForm } from './calibration_form';
import { camerasOf, lensOf, requestOf } from './calibration_form';
import type { CalibrationPage } from './calibration_page';
import { chooseFirst } from './calibration_page';
import { leftOutBy, sameViews } from './calibration_results';
import type { SectionTaker } from './calibration_use';
import { useInScenario } from './calibration_use';
import type { Later } from './image_sender';
import { ImageSender } from './image_sender';

/** While a camera is shown, and otherwise. */
const kLivePeriod_ms = 150;
const kQuietPeriod_ms = 600;
/** While a viewer waits for an operator's session. */
const kSeekPeriod_ms = 3000;

const kClosed = 'The calibration was closed by the server.';

export interface ScenarioReader {
  scenario(name: string): Promise<JsonObject>;
}

export class CalibrationDesk {
  /** Increases when a session is begun or left: answers about the one before are dropped. */
  private generation = 0;
  /** Numbers of the latest requests for the lists, and for what is saved. */
  private listing = 0;
  private readingSaved = 0;
  private polling = false;
  /** Ends when the last estimate that was asked for is agreed to or refused. */
  private asking: Promise<void> = Promise.resolve();
  /** What the last estimate that the server agreed to leaves out, until the session says so. */
  private agreed: ReadonlySet<number> | null = null;
  private readonly sender: ImageSender;

  constructor(
    private readonly store: Store,
    private readonly client: CalibrationClient,
    private readonly scenarios: ScenarioReader,
    private readonly sections: SectionTaker,
    private readonly notices: Notices,
    private readonly later: Later,
  ) {
    this.sender = new ImageSender(store, client, later);
  }

  async open(): Promise<void> {
    const { page } = this;
    this.store.state.openPage(page);
    const { scenarioName } = this.store.state;
    if (page.form.names.scenario === '' && scenarioName !== null) {
      page.form.names.scenario = scenarioName;
    }
    this.changed();
    await Promise.all([this.readLists(), this.readCameras(), this.resume()]);
  }

  /** The session goes on; a live camera is let go by the server after a while. */
  close(): void {
    this.page.open = false;
    this.changed();
  }

  async readLists(): Promise<void> {
    const { page } = this;
    const number = ++this.listing;
    try {
      const [sources] = await Promise.all([this.client.sources(), this.readSaved()]);
      if (number !== this.listing) return;
      page.sources = sources;
      page.listError = null;
      chooseFirst(page);
    } catch (error) {
      if (number !== this.listing) return;
      page.listError = errorText(error);
    }
    this.changed();
  }

  /** A later answer is newer, whichever comes first. */
  private async readSaved(): Promise<void> {
    const number = ++this.readingSaved;
    const saved = await this.client.saved();
    if (number === this.readingSaved) this.page.saved = saved;
  }

  /** Changes the form. */
  set(change: Partial<CalibrationForm>): void {
    Object.assign(this.page.form, change);
    this.page.error = null;
    this.changed();
  }

  async chooseName(name: string): Promise<void> {
    const { form } = this.page;
    form.names[form.kind] = name;
    this.set({});
    if (form.kind === 'scenario') await this.readCameras();
  }

  async begin(): Promise<void> {
    const { page } = this;
    const request = requestOf(page.form);
    if ('error' in request) {
      page.error = request.error;
      this.changed();
      return;
    }
    await this.request(async () => {
      if (page.session !== null) await this.client.end(page.session.id).catch(() => undefined);
      this.forget();
      this.show(await this.client.begin(request.value));
      this.poll();
    });
  }

  async end(): Promise<void> {
    const { session } = this.page;
    if (session === null) return;
    this.forget();
    await this.request(() => this.client.end(session.id));
  }

  async control(control: SessionControl): Promise<void> {
    const { session } = this.page;
    if (session === null) return;
    await this.request(async () => {
      if (control.clear === true) {
        this.agreed = null;
        Object.assign(this.page, { selected: null, leftOut: null });
      }
      this.show(await this.client.control(session.id, control));
    });
  }

  /** Estimates the camera with the lens of the form. */
  async solve(): Promise<void> {
    const { session, leftOut } = this.page;
    if (session !== null) await this.solveWithout(leftOut ?? leftOutBy(session));
  }

  /** Leaves a view out of the estimate, or takes it in again. */
  async toggleView(view: number): Promise<void> {
    const { session, leftOut } = this.page;
    if (session === null) return;
    const left = new Set(leftOut ?? leftOutBy(session));
    if (!left.delete(view)) left.add(view);
    await this.solveWithout(left);
  }

  async select(view: number | null): Promise<void> {
    const { page } = this;
    page.selected = view;
    this.changed();
    await this.readDetail();
  }

  /** Sends images, after those that are being sent. */
  send(files: readonly File[]): Promise<void> {
    return this.sender.send(files);
  }

  async save(name: string): Promise<void> {
    const { page } = this;
    const { session } = page;
    page.name = name;
    if (session === null) return;
    await this.request(async () => {
      await this.client.save(session.id, name);
      await this.readSaved();
      this.notices.info(`Saved as ${name}.`);
    });
  }

  async remove(name: string): Promise<void> {
    await this.request(async () => {
      await this.client.remove(name);
      await this.readSaved();
    });
  }

  /**
   * The scenario of the launcher, with its changes, uses a saved calibration in its next flight.
   */
  useInScenario(file: string, name: string): void {
    useInScenario(this.store.state, this.sections, this.notices, { file, name });
  }

  /** A saved calibration for another program; null, with the reason shown, if there is none. */
  async file(name: string, format: string): Promise<Blob | null> {
    try {
      return await this.client.file(name, format);
    } catch (error) {
      this.notices.error(`${name} cannot be downloaded: ${errorText(error)}`);
      return null;
    }
  }

  imageUrl(image: number): string {
    const { session } = this.page;
    return session === null ? '' : this.client.imageUrl(session.id, image);
  }

  /** Goes on with a session that a reloaded page has lost. */
  private async resume(): Promise<void> {
    if (this.page.session === null && this.store.state.mayChange) await this.seek();
    this.poll();
  }

  /** Shows the newest session of the server. */
  private async seek(): Promise<void> {
    const { page, generation } = this;
    try {
      const session = (await this.client.sessions()).at(-1);
      if (this.generation !== generation) return;
      if (session !== undefined && page.error === kClosed) page.error = null;
      if (session !== undefined) this.show(session);
      this.notePolled(null);
    } catch (error) {
      if (this.isSeeking) this.notePolled(errorText(error));
    }
  }

  private async readCameras(): Promise<void> {
    const { page } = this;
    const name = page.form.names.scenario;
    page.cameras = null;
    if (name === '') return;
    try {
      const cameras = camerasOf(await this.scenarios.scenario(name));
      if (page.form.names.scenario !== name) return;
      page.cameras = cameras;
      page.form.camera = cameras[0] ?? '';
    } catch (error) {
      page.error = errorText(error);
    }
    this.changed();
  }

  /** One request after the other: the last one counts. */
  private async solveWithout(left: ReadonlySet<number>): Promise<void> {
    const { page, generation } = this;
    page.leftOut = left;
    this.changed();
    this.asking = this.asking.then(async () => {
      if (this.generation === generation) await this.request(() => this.askWithout(left));
    });
    await this.asking;
  }

  private async askWithout(left: ReadonlySet<number>): Promise<void> {
    const { page, generation } = this;
    const { session, form } = page;
    if (session === null) return;
    try {
      const views = [...left].sort((a, b) => a - b);
      const answer = await this.client.solve(session.id, lensOf(form), views);
      if (this.generation !== generation) return;
      this.agreed = left;
      this.show(answer);
    } catch (error) {
      if (this.generation === generation && page.leftOut === left) page.leftOut = this.agreed;
      throw error;
    }
  }

  /** Follows the session; where there is none, a viewer's page looks for one. */
  private poll(): void {
    if (this.polling) return;
    this.polling = true;
    const turn = async () => {
      const { page } = this;
      if (!page.open || (page.session === null && !this.isSeeking)) {
        this.polling = false;
        return;
      }
      await (this.isSeeking ? this.seek() : this.ask());
      this.later(() => void turn(), this.period_ms());
    };
    void turn();
  }

  private get isSeeking(): boolean {
    return this.page.session === null && !this.store.state.mayChange;
  }

  private period_ms(): number {
    if (this.isSeeking) return kSeekPeriod_ms;
    const phase = this.page.session?.phase;
    return phase === 'taking' || phase === 'solving' ? kLivePeriod_ms : kQuietPeriod_ms;
  }

  private async ask(): Promise<void> {
    const { page, generation } = this;
    if (page.session === null) return;
    try {
      const session = await this.client.session(page.session.id, page.session.revision);
      if (this.generation !== generation) return;
      if (session !== null) this.show(session);
      await this.readSolution();
      this.notePolled(null);
    } catch (error) {
      if (this.generation !== generation) return;
      if (error instanceof RestError && error.status === 404) {
        this.forget();
        page.error = kClosed;
        this.changed();
      } else {
        this.notePolled(errorText(error));
      }
    }
  }

  private notePolled(error: string | null): void {
    if (this.page.pollError === error) return;
    this.page.pollError = error;
    this.changed();
  }

  private async readSolution(): Promise<void> {
    const { page, generation } = this;
    const { session } = page;
    if (session === null || session.solution === (page.solution?.solution ?? null)) return;
    const solution = session.solution === null ? null : await this.client.solution(session.id);
    if (this.generation !== generation) return;
    page.solution = solution;
    this.changed();
    await this.readDetail();
  }

  private async readDetail(): Promise<void> {
    const { page, generation } = this;
    const { session, selected } = page;
    page.detail = null;
    if (session === null || selected === null) return;
    try {
      const detail = await this.client.view(session.id, selected);
      if (this.generation !== generation || page.selected !== selected) return;
      page.detail = detail;
    } catch {
      page.selected = null;
    }
    this.changed();
  }

  private show(session: CalibrationSession): void {
    const { page, agreed } = this;
    page.session = session;
    if (agreed !== null && sameViews(agreed, leftOutBy(session))) {
      this.agreed = null;
      if (page.leftOut === agreed) page.leftOut = null;
    }
    this.changed();
  }

  private forget(): void {
    this.generation += 1;
    this.agreed = null;
    Object.assign(this.page, {
      session: null,
      solution: null,
      leftOut: null,
      selected: null,
      detail: null,
      sending: null,
      pollError: null,
    });
    this.changed();
  }

  private async request(action: () => Promise<unknown>): Promise<void> {
    const { page } = this;
    page.busy = true;
    page.error = null;
    this.changed();
    try {
      await action();
    } catch (error) {
      page.error = errorText(error);
    }
    page.busy = false;
    this.changed();
  }

  private get page(): CalibrationPage {
    return this.store.state.calibrationPage;
  }

  private changed(): void {
    this.store.change('calibration');
  }
}
