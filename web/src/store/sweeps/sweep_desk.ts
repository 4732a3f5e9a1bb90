// Reads the sweeps of the server, again and again while their page is open or one flies; cancels
// continues and deletes them.
import { errorText } from '../../connection/rest_error';
import type { SweepClient } from '../../connection/sweep_client';
import type { SweepEntry } from '../../protocol/sweep_types';
import type { Notices } from '../notices';
import type { Session } from '../session';
import type { Store } from '../state';
import { SweepForm } from './sweep_form';
import { initialSweepResults, SweepResults } from './sweep_results';
import type { SweepFigure } from './sweep_matrix';
import type { SweepPage } from './sweep_page';

const kPollFlying_ms = 3000;
const kPollIdle_ms = 15000;

export class SweepDesk {
  readonly form: SweepForm;
  readonly results: SweepResults;
  /** Of the last chain of polls: an older one ends. */
  private chain = 0;
  /** Sweeps that this viewer cancelled. */
  private readonly cancelled = new Set<string>();

  constructor(
    private readonly store: Store,
    private readonly client: SweepClient,
    private readonly session: Session,
    private readonly notices: Notices,
    private readonly later: (callback: () => void, delay_ms: number) => void,
  ) {
    this.results = new SweepResults(store, client, notices);
    this.form = new SweepForm(store, client, later, (name) => this.show(name));
  }

  async open(): Promise<void> {
    this.store.state.openPage(this.page);
    this.changed();
    await this.readAgain();
  }

  close(): void {
    this.page.open = false;
    this.changed();
  }

  async choose(name: string): Promise<void> {
    if (this.page.name !== name) this.forget(name);
    this.changed();
    await this.readShown();
  }

  /** Ends the flights of a sweep that this server flies. */
  async cancel(name: string): Promise<void> {
    try {
      await this.client.cancel(name);
      this.cancelled.add(name);
    } catch (error) {
      this.notices.error(errorText(error));
    }
    await this.readAgain();
  }

  /** Flies what a sweep lacks; a border that was not found is sought on. */
  async continue(name: string): Promise<void> {
    const sought = this.page.sweeps?.find((sweep) => sweep.name === name)?.envelope ?? null;
    try {
      await this.client.continue(
        name,
        sought === null || sought.found
          ? {}
          : { border: { axis: sought.axis, estimator: sought.estimator } },
      );
    } catch (error) {
      this.notices.error(errorText(error));
    }
    await this.show(name);
  }

  /** Deletes a sweep that does not fly, with its flights. */
  async remove(name: string): Promise<void> {
    try {
      await this.client.remove(name);
      if (this.page.name === name) this.forget(null);
    } catch (error) {
      this.notices.error(errorText(error));
    }
    await this.readAgain();
  }

  /** Shows a flight of the sweep in the dashboard. */
  openRun(id: string): void {
    this.session.selectRun(id);
    this.close();
  }

  chooseFigure(figure: SweepFigure): void {
    this.page.figure = figure;
    this.changed();
  }

  /** An axis along the columns or rows; the other one gives way if it was there. */
  chooseAxis(place: 'columns' | 'rows', name: string, shown: { columns: string; rows: string }) {
    const other = place === 'columns' ? 'rows' : 'columns';
    this.page[other] = shown[other] === name ? shown[place] : shown[other];
    this.page[place] = name;
    this.page.cell = null;
    this.changed();
  }

  /** The axis whose values have matrices next to each other; '' = none. */
  choosePanels(name: string): void {
    this.page.panels = name;
    this.page.cell = null;
    this.changed();
  }

  fix(axis: string, value: string): void {
    this.page.fixed = { ...this.page.fixed, [axis]: value };
    this.page.cell = null;
    this.changed();
  }

  chooseCell(cell: string | null): void {
    this.page.cell = this.page.cell === cell ? null : cell;
    this.changed();
  }

  private get page(): SweepPage {
    return this.store.state.sweepPage;
  }

  private forget(name: string | null): void {
    Object.assign(this.page, {
      name,
      shown: null,
      columns: null,
      rows: null,
      panels: null,
      fixed: {},
      cell: null,
      results: { ...initialSweepResults(), published: this.page.results.published },
    });
  }

  /** At once, and then as usual: a page that was closed meanwhile stays closed. */
  private async readAgain(): Promise<void> {
    this.chain += 1;
    await this.poll(this.chain);
  }

  private async poll(chain: number): Promise<void> {
    const { page } = this;
    try {
      const before = page.sweeps ?? [];
      page.sweeps = await this.client.sweeps();
      page.error = null;
      this.announceEnded(before, page.sweeps);
      if (page.name === null || !page.sweeps.some(({ name }) => name === page.name)) {
        this.forget(page.sweeps[0]?.name ?? null);
      }
    } catch (error) {
      page.error = errorText(error);
    }
    if (page.open) await this.readShown();
    if (chain !== this.chain) return;
    const flying = page.sweeps?.some((sweep) => sweep.flying) === true;
    if (!page.open && !flying) return;
    this.later(
      () => {
        if (chain === this.chain) void this.poll(chain);
      },
      flying ? kPollFlying_ms : kPollIdle_ms,
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
      const shown = await this.client.sweep(name);
      if (page.name !== name) return;
      page.shown = shown;
      page.error = null;
    } catch (error) {
      if (page.name === name) page.error = errorText(error);
    }
    this.changed();
  }

  /** A sweep that was just started or continued. */
  private async show(name: string): Promise<void> {
    this.cancelled.delete(name);
    if (this.page.name !== name) this.forget(name);
    await this.readAgain();
  }

  /** Says which sweeps ended; those that the viewer cancelled are not announced. */
  private announceEnded(before: readonly SweepEntry[], now: readonly SweepEntry[]): void {
    const flew = new Set(before.filter(({ flying }) => flying).map(({ name }) => name));
    for (const { name, title, flying, progress, problem, envelope } of now) {
      if (flying || !flew.has(name) || this.cancelled.has(name)) continue;
      const shown = title === '' ? name : title;
      if (problem !== null) {
        this.notices.error(`${shown}: the sweep failed. ${problem}`);
      } else if (envelope?.found === true) {
        const flights = `${progress?.passed ?? 0} of ${progress?.most ?? 0} flights`;
        this.notices.info(`${shown}: the border is found, with ${flights}.`);
      } else if (progress !== null && progress.passed < progress.most) {
        const flights = `${progress.passed} of ${progress.most} flights`;
        this.notices.info(`${shown}: the sweep stopped after ${flights}.`);
      } else {
        this.notices.info(`${shown}: the sweep is complete.`);
      }
    }
  }

  private changed(): void {
    this.store.change('sweeps');
  }
}
