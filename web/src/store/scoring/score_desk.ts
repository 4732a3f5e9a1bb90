// Chooses trajectories, uploads them and has the server score them. The page computes no score.
import { errorText } from '../../connection/rest_error';
import type { RestClient } from '../../connection/rest_client';
import type { Upload } from '../../connection/upload';
import type { EvaluationRequest } from '../../protocol/score_types';
import type { Run } from '../../protocol/rest_types';
import type { Store } from '../state';
import { plainName } from '../logs/upload_set';
import type { ScorePage } from './score_page';
import type { PlannedUpload } from './upload_plan';
import { uploadPlan } from './upload_plan';

/** Limits of the server: estimates, and points of all of them. */
export const kMostEstimates = 32;
const kMostPoints = 100_000;
const kPoints = 6000;
const kLeastPoints = 100;
/** Begins the name of a log's trajectory. */
const kLog = 'log:';

export interface TrajectoryChoice {
  /** As in docs/PROTOCOL.md. */
  name: string;
  label: string;
  detail: string;
  uploaded: boolean;
}

export interface ChoiceGroup {
  title: string;
  choices: TrajectoryChoice[];
}

export class ScoreDesk {
  private scoring = new AbortController();
  /** Number of the latest request for the lists. */
  private listing = 0;

  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
    private readonly upload: Upload,
  ) {}

  async open(): Promise<void> {
    this.store.state.openPage(this.page);
    this.changed();
    // What was chosen when the page was closed is not scored yet.
    const scoring = this.scoring.signal.aborted ? this.score() : null;
    await Promise.all([this.readLists(), scoring]);
  }

  close(): void {
    if (this.page.working) this.scoring.abort();
    this.page.working = false;
    this.page.open = false;
    this.changed();
  }

  async readLists(): Promise<void> {
    const { page } = this;
    const number = ++this.listing;
    try {
      const [files, logs] = await Promise.all([this.rest.trajectories(), this.rest.logs()]);
      // A later answer is newer, whichever comes first.
      if (number !== this.listing) return;
      page.files = files;
      page.logs = logs.logs;
      page.listError = null;
    } catch (error) {
      if (number !== this.listing) return;
      page.listError = errorText(error);
    }
    this.changed();
  }

  /** The truth sets the time base. */
  async chooseTruth(name: string): Promise<void> {
    const { page } = this;
    page.truth = name;
    page.estimates = page.estimates.filter((estimate) => estimate !== name);
    await this.score();
  }

  async toggle(name: string): Promise<void> {
    const { page } = this;
    if (page.estimates.includes(name)) {
      page.estimates = page.estimates.filter((estimate) => estimate !== name);
    } else if (page.estimates.length >= kMostEstimates) {
      page.error = `Not more than ${kMostEstimates} trajectories can be scored together.`;
      this.changed();
      return;
    } else {
      page.estimates = [...page.estimates, name];
      if (page.truth === name) page.truth = null;
    }
    await this.score();
  }

  async chooseAlignment(alignment: string): Promise<void> {
    this.page.alignment = alignment;
    await this.score();
  }

  /**
   * Uploads trajectories and flight logs; each is then scored, the first without a truth as such.
   */
  async send(files: readonly File[]): Promise<void> {
    const { page } = this;
    try {
      for (const upload of await uploadPlan(files)) {
        const name = await this.sendOne(upload);
        await this.readLists();
        if (page.truth === null) await this.chooseTruth(name);
        else if (name !== page.truth && !page.estimates.includes(name)) await this.toggle(name);
      }
    } catch (error) {
      page.error = errorText(error);
      this.changed();
    }
  }

  /** @return the trajectory's name */
  private async sendOne(planned: PlannedUpload): Promise<string> {
    const progress = (share: number) => {
      this.page.upload = { name: planned.name, share };
      this.changed();
    };
    progress(0);
    try {
      if (planned.kind === 'trajectory') {
        const name = plainName(planned.name);
        return (await this.rest.uploadTrajectory(this.upload, name, planned.body, progress)).name;
      }
      const { query, body } = planned;
      const never = new AbortController().signal;
      return kLog + (await this.rest.uploadLog(this.upload, query, body, progress, never)).name;
    } catch (error) {
      throw new Error(`${planned.name}: ${errorText(error)}`);
    } finally {
      this.page.upload = null;
    }
  }

  /** Deletes an uploaded file or log. */
  async remove(name: string): Promise<void> {
    const { page } = this;
    try {
      if (name.startsWith(kLog)) await this.rest.deleteLog(name.slice(kLog.length));
      else await this.rest.deleteTrajectory(name);
      page.estimates = page.estimates.filter((estimate) => estimate !== name);
      if (page.truth === name) page.truth = null;
    } catch (error) {
      page.error = errorText(error);
      await this.readLists();
      return;
    }
    await this.readLists();
    await this.score();
  }

  /** A new request ends the one before, here and on the server. */
  private async score(): Promise<void> {
    const { page } = this;
    this.scoring.abort();
    const scoring = new AbortController();
    this.scoring = scoring;
    page.error = null;
    const { truth, estimates, alignment } = page;
    if (truth === null || estimates.length === 0) {
      page.scores = null;
      page.series = null;
      page.working = false;
      this.changed();
      return;
    }
    page.working = true;
    this.changed();
    const points = Math.max(kLeastPoints, Math.min(kPoints, kMostPoints / estimates.length));
    const request = { truth, estimates };
    const over: EvaluationRequest = {
      ...request,
      alignments: [alignment],
      points: Math.floor(points),
    };
    try {
      const { signal } = scoring;
      const scores = await this.rest.evaluate(
        { ...request, alignments: ['all'], find_offsets: true },
        signal,
      );
      const series = await this.rest.evaluate(over, signal);
      if (signal.aborted) return;
      page.scores = scores;
      page.series = series;
    } catch (error) {
      if (scoring.signal.aborted) return;
      page.scores = null;
      page.series = null;
      page.error = errorText(error);
    }
    page.working = false;
    this.changed();
  }

  private get page(): ScorePage {
    return this.store.state.scorePage;
  }

  private changed(): void {
    this.store.change('scoring');
  }
}

/** What can be chosen: files by folder, ended runs, logs. */
export function choiceGroups(page: ScorePage, runs: readonly Run[] | null): ChoiceGroup[] {
  const groups = new Map<string, TrajectoryChoice[]>();
  const add = (title: string, choice: TrajectoryChoice) => {
    const choices = groups.get(title) ?? [];
    groups.set(title, [...choices, choice]);
  };
  for (const { name, format, folder, uploaded } of page.files?.trajectories ?? []) {
    const label = name.slice(name.lastIndexOf('/') + 1);
    add(uploaded ? 'Uploaded files' : `Files in ${folder}`, {
      name,
      label,
      detail: format,
      uploaded,
    });
  }
  for (const { id, title, status, estimators } of runs ?? []) {
    if (status === 'queued' || status === 'running' || status === 'unreadable') continue;
    for (const track of ['truth', ...estimators]) {
      const name = `run:${id}/${track}`;
      add(`Run ${title}, ${id}`, { name, label: track, detail: '', uploaded: false });
    }
  }
  for (const { name, format, uploaded } of page.logs ?? []) {
    add('Flight logs', { name: kLog + name, label: name, detail: format, uploaded });
  }
  return [...groups].map(([title, choices]) => ({ title, choices }));
}

/** The last parts of a trajectory's name. */
export function shortName(name: string): string {
  const parts = name.replace(/^[a-z]+:/, '').split('/');
  return parts.slice(-2).join('/');
}
