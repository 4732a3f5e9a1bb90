// The page of flight logs: listed, uploaded, looked at, flown.
import type { RestClient } from '../../connection/rest_client';
import { errorText, fieldErrorsOf } from '../../connection/rest_error';
import type { Upload } from '../../connection/upload';
import type { FieldError } from '../../protocol/field_errors';
import type { LogEntry, LogInfo, LogList, LogSeries, WorldExtent } from '../../protocol/log_types';
import type { Session } from '../session';
import type { Store } from '../state';
import type { LogFlight } from './log_flight';
import { flyableSources, logOverrides, newLogFlight } from './log_flight';
import type { LogSmoothingState } from './log_smoothing';
import { initialSmoothing } from './log_smoothing';
import type { UploadSet } from './upload_set';
import { uploadQuery, uploadSets } from './upload_set';

export interface UploadProgress {
  name: string;
  share: number;
}

export interface LogPage {
  open: boolean;
  list: LogList | null;
  /** Name of the chosen log. */
  chosen: string | null;
  /** null while the server reads the log. */
  info: LogInfo | null;
  series: LogSeries | null;
  reading: boolean;
  /** Why the chosen log, or its series, cannot be shown. */
  error: string | null;
  listError: string | null;
  upload: UploadProgress | null;
  uploadError: string | null;
  flight: LogFlight;
  flightErrors: FieldError[];
  starting: boolean;
  smoothing: LogSmoothingState;
  /** By scenario; null: not known. */
  worlds: Map<string, WorldExtent | null>;
}

export function initialLogPage(): LogPage {
  return {
    open: false,
    list: null,
    chosen: null,
    info: null,
    series: null,
    reading: false,
    error: null,
    listError: null,
    upload: null,
    uploadError: null,
    flight: newLogFlight(''),
    flightErrors: [],
    starting: false,
    smoothing: initialSmoothing(),
    worlds: new Map(),
  };
}

export class LogBrowser {
  private reading = new AbortController();
  private sending: AbortController | null = null;
  /** Logs that wait for the one that is being uploaded. */
  private unsent: UploadSet<File>[] = [];
  /** Whether the viewer has chosen a log since the last files were given: uploads then change nothing of it. */
  private choseMeanwhile = false;
  /** Number of the latest request for the list. */
  private listing = 0;

  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
    private readonly session: Session,
    private readonly upload: Upload,
    private readonly newKey: () => string,
  ) {}

  async open(): Promise<void> {
    const { page } = this;
    this.store.state.openPage(page);
    // A world that was not there may have been made meanwhile.
    for (const [name, world] of page.worlds) if (world === null) page.worlds.delete(name);
    const { scenarioName, scenarios } = this.store.state;
    const flyable = scenarios?.filter(({ error }) => error === null) ?? [];
    if (page.flight.scenario === '') {
      page.flight.scenario = scenarioName ?? flyable[0]?.name ?? '';
    }
    this.changed();
    await this.readList();
  }

  close(): void {
    this.page.open = false;
    this.changed();
  }

  async readList(): Promise<void> {
    const number = ++this.listing;
    try {
      const list = await this.rest.logs();
      // A later answer is newer, whichever comes first.
      if (number !== this.listing) return;
      this.page.list = list;
      this.page.listError = null;
    } catch (error) {
      if (number !== this.listing) return;
      this.page.listError = errorText(error);
    }
    this.changed();
  }

  async choose(name: string): Promise<void> {
    this.choseMeanwhile = true;
    await this.show(name);
  }

  private async show(name: string): Promise<void> {
    const { page } = this;
    page.chosen = name;
    page.info = null;
    page.series = null;
    page.flight = { ...newLogFlight(page.flight.scenario), estimators: page.flight.estimators };
    page.flightErrors = [];
    await this.read(async (signal) => {
      const info = await this.rest.log(name, signal);
      signal.throwIfAborted();
      page.info = info;
      const best = info.truth?.position ?? '';
      // Positions of an unknown place cannot be flown.
      if (!flyableSources(info).includes(best)) page.flight.smooth = false;
      this.changed();
      const series = await this.rest.logSeries(name, '', signal);
      signal.throwIfAborted();
      page.series = series;
    });
  }

  async chooseSource(source: string): Promise<void> {
    const { page } = this;
    const name = page.chosen;
    if (name === null) return;
    page.flight.source = source;
    await this.read(async (signal) => {
      const series = await this.rest.logSeries(name, source, signal);
      signal.throwIfAborted();
      page.series = series;
    });
  }

  /** Changes the form. */
  set(changes: Partial<LogFlight>): void {
    Object.assign(this.page.flight, changes);
    this.page.flightErrors = [];
    this.changed();
  }

  /**
   * Uploads logs one after another, or a mapping with its CSV files as one log. Those chosen during
   * an upload come after it; an error ends it for all.
   */
  async send(files: readonly File[]): Promise<void> {
    const { page } = this;
    if (files.length === 0) return;
    const sets = uploadSets(files);
    page.uploadError = typeof sets === 'string' ? sets : null;
    this.changed();
    if (typeof sets === 'string') return;
    this.unsent.push(...sets);
    this.choseMeanwhile = false;
    await this.sendNext();
  }

  private async sendNext(): Promise<void> {
    if (this.page.upload !== null) return;
    const next = this.unsent.shift();
    if (next === undefined) return;
    await this.sendOne(next);
    await this.sendNext();
  }

  private async sendOne(files: UploadSet<File>): Promise<void> {
    const { page } = this;
    const { name } = files[0];
    const progress = (share: number) => {
      page.upload = { name, share };
      this.changed();
    };
    progress(0);
    this.sending = new AbortController();
    let entry: LogEntry;
    try {
      entry = await this.rest.uploadLog(
        this.upload,
        uploadQuery(files),
        files.length === 1 ? files[0] : new Blob([...files]),
        progress,
        this.sending.signal,
      );
    } catch (error) {
      const left = this.unsent.splice(0).map(([file]) => file.name);
      const others = left.length === 0 ? '' : `\nNot uploaded: ${left.join(', ')}`;
      page.uploadError = `${name}: ${errorText(error)}${others}`;
      return;
    } finally {
      page.upload = null;
      this.changed();
    }
    // The next upload may begin meanwhile.
    await this.readList();
    if (!this.choseMeanwhile) await this.show(entry.name);
  }

  cancelUpload(): void {
    this.sending?.abort();
  }

  async remove(name: string): Promise<void> {
    try {
      await this.rest.deleteLog(name);
      if (this.page.chosen === name) {
        this.reading.abort();
        this.page.reading = false;
        this.page.error = null;
        this.page.chosen = null;
        this.page.info = null;
        this.page.series = null;
        this.page.flight = newLogFlight(this.page.flight.scenario);
      }
    } catch (error) {
      await this.readList();
      this.page.listError = errorText(error);
      this.changed();
      return;
    }
    await this.readList();
  }

  async fly(): Promise<void> {
    const { page } = this;
    const entry = page.list?.logs.find(({ name }) => name === page.chosen);
    if (entry === undefined || page.starting) return;
    page.starting = true;
    page.flightErrors = [];
    this.changed();
    // The form as it is now: another log may be chosen meanwhile.
    const flight = { ...page.flight };
    try {
      const document = await this.rest.scenario(flight.scenario);
      const { overrides, errors } = logOverrides(flight, entry.file, document);
      if (page.chosen === entry.name) page.flightErrors = errors;
      if (errors.length === 0) {
        const run = await this.rest.startRun(flight.scenario, overrides, this.newKey());
        const { state } = this.store;
        state.runs = [run, ...(state.runs ?? []).filter(({ id }) => id !== run.id)];
        page.open = false;
        this.session.selectRun(run.id);
        this.store.change('lists');
      }
    } catch (error) {
      if (page.chosen === entry.name) page.flightErrors = fieldErrorsOf(error);
      else page.flightErrors = [{ field: '', message: `${entry.name}: ${errorText(error)}` }];
    }
    page.starting = false;
    this.changed();
  }

  /** A new reading ends the one before, here and on the server. */
  private async read(action: (signal: AbortSignal) => Promise<void>): Promise<void> {
    this.reading.abort();
    const reading = new AbortController();
    this.reading = reading;
    this.page.reading = true;
    this.page.error = null;
    this.changed();
    try {
      await action(reading.signal);
    } catch (error) {
      if (reading.signal.aborted) return;
      this.page.error = errorText(error);
      this.page.series = null;
    }
    if (reading.signal.aborted) return;
    this.page.reading = false;
    this.changed();
  }

  private get page(): LogPage {
    return this.store.state.logPage;
  }

  private changed(): void {
    this.store.change('logs');
  }
}
