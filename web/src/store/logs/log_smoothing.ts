// What smoothing leaves of the chosen log's samples: asked for while it is shown, with progress.
import { errorText } from '../../connection/rest_error';
import type { RestClient } from '../../connection/rest_client';
import type { LogResiduals, WorkProgress } from '../../protocol/log_types';
import type { Store } from '../state';
import type { LogPage } from './log_browser';

export interface LogSmoothingState {
  /** Shown in place of the log's curves. */
  open: boolean;
  /** What was asked for; empty: nothing yet. */
  key: string;
  /** While the server works. */
  progress: WorkProgress | null;
  residuals: LogResiduals | null;
  /** Why there are none. */
  error: string | null;
}

export function initialSmoothing(): LogSmoothingState {
  return { open: false, key: '', progress: null, residuals: null, error: null };
}

const kPoll_ms = 400;

export class LogSmoothing {
  private working = new AbortController();
  /** The log of the last request. */
  private log: string | null = null;

  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
    private readonly later: (callback: () => void, delay_ms: number) => void,
    private readonly newKey: () => string,
  ) {}

  show(open: boolean): void {
    this.state.open = open;
    this.changed();
    this.refresh();
  }

  /** Smooths again after cancel(). */
  again(): void {
    this.state.key = '';
    this.refresh();
  }

  cancel(): void {
    this.working.abort();
    this.state.progress = null;
    this.state.error = 'Cancelled';
    this.changed();
  }

  /** Smooths the chosen slice if it is not the one that is shown. Ends what is not wanted any more. */
  refresh(): void {
    const { state, page } = this;
    const name = page.chosen;
    if (name !== this.log) this.forget(name);
    const wanted = page.open && state.open && name !== null && page.info !== null;
    if (!wanted) {
      if (state.progress === null) return;
      this.working.abort();
      state.progress = null;
      state.key = '';
      this.changed();
      return;
    }
    const { source, from_s, to_s, autoOffset } = page.flight;
    const key = JSON.stringify([name, source, from_s, to_s, autoOffset]);
    if (key === state.key) return;
    this.working.abort();
    const working = new AbortController();
    this.working = working;
    Object.assign(state, {
      key,
      residuals: null,
      error: null,
      progress: { step: 'waiting', share: 0 },
    });
    this.changed();
    void this.work(name, working);
  }

  /** Drops what belongs to the log before. */
  private forget(log: string | null): void {
    this.log = log;
    if (this.state.key === '') return;
    this.working.abort();
    Object.assign(this.state, { key: '', progress: null, residuals: null, error: null });
    this.changed();
  }

  private async work(name: string, working: AbortController): Promise<void> {
    const { state, page } = this;
    const { source, from_s, to_s, autoOffset } = page.flight;
    const id = this.newKey();
    this.follow(id, working);
    let outcome: Pick<LogSmoothingState, 'residuals' | 'error'>;
    try {
      const request = { source, from_s, to_s, autoOffset };
      const residuals = await this.rest.logResiduals(name, request, id, working.signal);
      outcome = { residuals, error: null };
    } catch (error) {
      const text = errorText(error);
      outcome = { residuals: null, error: text };
    }
    if (working.signal.aborted) return;
    Object.assign(state, outcome, { progress: null });
    this.changed();
  }

  /** Asks for the progress as long as the work goes on. */
  private follow(id: string, working: AbortController): void {
    this.later(() => {
      const { state } = this;
      const going = () => !working.signal.aborted && state.progress !== null;
      if (!going()) return;
      void this.rest.progress(id).then((progress) => {
        if (!going()) return;
        if (progress !== null) {
          state.progress = progress;
          this.changed();
        }
        this.follow(id, working);
      });
    }, kPoll_ms);
  }

  private get page(): LogPage {
    return this.store.state.logPage;
  }

  private get state(): LogSmoothingState {
    return this.page.smoothing;
  }

  private changed(): void {
    this.store.change('logs');
  }
}
