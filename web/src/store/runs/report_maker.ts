// Lets the server write the report of the runs that are shown together.
import { errorText } from '../../connection/rest_error';
import { isActive } from '../../protocol/rest_types';
import type { Notices } from '../notices';
import type { Store } from '../state';
import type { WatchedRun } from '../watched_run';

export interface ReportRest {
  report: (runs: readonly string[], alignment: string) => Promise<Blob>;
}

export interface Report {
  fileName: string;
  page: Blob;
}

export class ReportMaker {
  private making = false;

  constructor(
    private readonly store: Store,
    private readonly rest: ReportRest,
    private readonly notices: Notices,
  ) {}

  get busy(): boolean {
    return this.making;
  }

  /** Ids of the shown runs that are over and still on the server. */
  runs(): string[] {
    const over = ({ run, deleted }: WatchedRun) => run !== null && !isActive(run) && !deleted;
    return this.store.state.watched.filter(over).map(({ id }) => id);
  }

  /** With the alignment that is chosen. Says why there is none. */
  async make(): Promise<Report | null> {
    const runs = this.runs();
    const reason = this.refusal(runs);
    if (reason !== null) {
      this.notices.error(reason);
      return null;
    }
    this.set(true);
    try {
      const page = await this.rest.report(runs, this.store.state.alignment);
      return { fileName: reportName(runs), page };
    } catch (error) {
      const text = errorText(error);
      this.notices.error(`The report cannot be made: ${text}`);
      return null;
    } finally {
      this.set(false);
    }
  }

  private refusal(runs: readonly string[]): string | null {
    if (this.making) return 'A report is being made already.';
    return runs.length === 0
      ? 'None of the shown runs has ended and is on the server: only such runs can be reported.'
      : null;
  }

  private set(making: boolean): void {
    this.making = making;
    this.store.change('run');
  }
}

function reportName(runs: readonly string[]): string {
  const part = runs.length === 1 ? (runs[0] ?? '') : `${runs.length}-runs`;
  return `overfly-report-${part.replace(/[^\w.-]/g, '-')}.html`;
}
