// Asks the server what a mission will be like, when its edits pause.
import type { RestClient } from '../../connection/rest_client';
import { fieldErrorsOf, isPassing, RestError } from '../../connection/rest_error';
import type { JsonObject } from '../../protocol/rest_types';
import type { Store } from '../state';
import type { MissionPage } from './mission_page';

const kPause_ms = 250;
const kBusy_ms = 1500;
/** While the server is away. */
const kAway_ms = 3000;

export class MissionReporter {
  private asking = new AbortController();
  /** Counts changes, so that only the last one asks. */
  private changes = 0;

  constructor(
    private readonly store: Store,
    private readonly rest: Pick<RestClient, 'missionReport'>,
    private readonly later: (callback: () => void, delay_ms: number) => void,
    /** The scenario to be reported; null = there is none. */
    private readonly document: () => JsonObject | null,
    /** Called when edits pause. */
    private readonly onPause: () => void,
  ) {}

  schedule(): void {
    this.changes += 1;
    this.page.outdated = this.page.report !== null;
    this.store.change('missions');
    this.askIn(kPause_ms);
  }

  cancel(): void {
    this.changes += 1;
    this.asking.abort();
  }

  private askIn(delay_ms: number): void {
    const { changes } = this;
    this.later(() => {
      if (changes !== this.changes) return;
      this.onPause();
      void this.ask();
    }, delay_ms);
  }

  private async ask(): Promise<void> {
    const { page } = this;
    this.asking.abort();
    const document = this.document();
    if (document === null || page.world === null || !page.open) return;
    if ((page.draft?.mission.items.length ?? 0) === 0) {
      this.take({ report: null, errors: [] });
      return;
    }
    const asking = new AbortController();
    this.asking = asking;
    const { camera, limits, overlapInterval_s } = page;
    try {
      const request = { document, camera, limits, overlap_interval_s: overlapInterval_s };
      const report = await this.rest.missionReport(request, asking.signal);
      if (!asking.signal.aborted) this.take({ report, errors: [] });
    } catch (error) {
      if (asking.signal.aborted) return;
      if (error instanceof RestError && error.code === 'too_many_readers') {
        this.askIn(kBusy_ms);
        return;
      }
      this.take({ report: null, errors: fieldErrorsOf(error) });
      if (isPassing(error)) this.askIn(kAway_ms);
    }
  }

  private take(result: Pick<MissionPage, 'report' | 'errors'>): void {
    Object.assign(this.page, result, { outdated: false });
    this.store.change('missions');
  }

  private get page(): MissionPage {
    return this.store.state.missionPage;
  }
}
