// Reads the studies of the server, again and again while their page is open or one is made; cancels,
// continues and deletes them.
import { errorText } from '../../connection/rest_error';
import type { StudyClient } from '../../connection/study_client';
import type { JsonObject, Run } from '../../protocol/rest_types';
import type { StudyEntry } from '../../protocol/study_types';
import { isOpen } from '../../protocol/study_types';
import type { RestClient } from '../../connection/rest_client';
import type { Notices } from '../notices';
import type { Session } from '../session';
import type { Store } from '../state';
import type { StudyScenario } from './study_form';
import { StudyForm } from './study_form';
import type { StudyPage } from './study_page';

const kPollMade_ms = 2000;
const kPollIdle_ms = 15000;

export class StudyDesk {
  readonly form: StudyForm;
  /** Of the last chain of polls: an older one ends. */
  private chain = 0;
  /** Studies that this viewer cancelled. */
  private readonly cancelled = new Set<string>();

  constructor(
    private readonly store: Store,
    private readonly client: StudyClient,
    rest: RestClient,
    private readonly session: Session,
    private readonly notices: Notices,
    private readonly later: (callback: () => void, delay_ms: number) => void,
  ) {
    this.form = new StudyForm(store, client, rest, (name) => this.show(name));
  }

  async open(): Promise<void> {
    this.store.state.openPage(this.page);
    this.changed();
    await this.readAgain();
  }

  /** Opens the page at a study. @param name  '' = at the newest */
  async openAt(name: string): Promise<void> {
    if (name !== '' && this.page.name !== name) this.forget(name);
    await this.open();
  }

  /** Prepares an explanation. @param run  null = of the newest run that failed */
  async explain(run: Run | null, estimator = ''): Promise<void> {
    await this.open();
    this.form.openExplain(run);
    if (estimator !== '') this.form.set('estimator', estimator);
  }

  /** Prepares a study of a scenario. @param source  null = as the server has it */
  async prepare(kind: 'predict' | 'hunt', source: StudyScenario): Promise<void> {
    await this.open();
    await this.form.openScenario(kind, source);
  }

  close(): void {
    this.page.open = false;
    this.changed();
  }

  async choose(name: string): Promise<void> {
    if (this.page.name !== name) this.forget(name);
    this.form.close();
    await this.readShown();
  }

  /** Ends a study that waits or is made. */
  async cancel(name: string): Promise<void> {
    await this.attempt(async () => {
      await this.client.cancel(name);
      this.cancelled.add(name);
    });
  }

  /** Makes a study that has ended again; what was flown is not flown twice. */
  async continue(name: string): Promise<void> {
    await this.attempt(async () => {
      await this.client.continue(name);
      this.cancelled.delete(name);
    });
  }

  /** Deletes a study that has ended, with its flights. */
  async remove(name: string): Promise<void> {
    await this.attempt(async () => {
      await this.client.remove(name);
      if (this.page.name === name) this.forget(null);
    });
  }

  /** Shows a flight of the study in the dashboard. */
  openRun(id: string): void {
    this.session.selectRun(id);
    this.close();
  }

  /** The scenario of a hunt's worst flight; null, with a notice, if there is none. */
  async worst(name: string): Promise<JsonObject | null> {
    try {
      return await this.client.worst(name);
    } catch (error) {
      this.notices.error(errorText(error));
      return null;
    }
  }

  pageAddress(name: string): string {
    return this.client.pageAddress(name);
  }

  private get page(): StudyPage {
    return this.store.state.studyPage;
  }

  private async attempt(action: () => Promise<void>): Promise<void> {
    try {
      await action();
    } catch (error) {
      this.notices.error(errorText(error));
    }
    await this.readAgain();
  }

  private forget(name: string | null): void {
    this.page.name = name;
    this.page.shown = null;
    this.changed();
  }

  /** At once, and then as usual: a page that was closed meanwhile stays closed. */
  private async readAgain(): Promise<void> {
    this.chain += 1;
    await this.poll(this.chain);
  }

  private async poll(chain: number): Promise<void> {
    const { page } = this;
    try {
      const before = page.studies ?? [];
      const { studies, limits } = await this.client.studies();
      page.studies = studies;
      page.limits = limits;
      page.error = null;
      this.announceEnded(before, studies);
      if (page.name === null || !studies.some(({ name }) => name === page.name)) {
        this.forget(studies[0]?.name ?? null);
      }
    } catch (error) {
      page.error = errorText(error);
    }
    if (page.open) await this.readShown();
    if (chain !== this.chain) return;
    const made = page.studies?.some(isOpen) === true;
    if (!page.open && !made) return;
    this.later(
      () => {
        if (chain === this.chain) void this.poll(chain);
      },
      made ? kPollMade_ms : kPollIdle_ms,
    );
  }

  private async readShown(): Promise<void> {
    const { page } = this;
    const { name } = page;
    if (name === null) {
      this.changed();
      return;
    }
    try {
      const shown = await this.client.study(name);
      if (page.name !== name) return;
      page.shown = shown;
      page.error = null;
    } catch (error) {
      if (page.name === name) page.error = errorText(error);
    }
    this.changed();
  }

  /** A study that was just started. */
  private async show(name: string): Promise<void> {
    this.forget(name);
    await this.readAgain();
  }

  /** Says which studies ended; those that the viewer cancelled are not announced. */
  private announceEnded(before: readonly StudyEntry[], now: readonly StudyEntry[]): void {
    const were = new Set(before.filter(isOpen).map(({ name }) => name));
    for (const study of now) {
      if (isOpen(study) || !were.has(study.name) || this.cancelled.has(study.name)) continue;
      const { state, title, problem } = study;
      if (state === 'done') this.notices.info(`${title}: the study is complete.`);
      else if (state === 'failed') this.notices.error(`${title}: failed. ${problem ?? ''}`.trim());
      else this.notices.info(`${title}: the study was ${state}.`);
    }
  }

  private changed(): void {
    this.store.change('studies');
  }
}
