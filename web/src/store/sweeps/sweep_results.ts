// What is made of a sweep's results: tables as files, and the comparison with another sweep.
import { errorText } from '../../connection/rest_error';
import type { SweepClient } from '../../connection/sweep_client';
import type { SweepComparison } from '../../protocol/sweep_types';
import type { Notices } from '../notices';
import type { Store } from '../state';

export const kTableFormats = [
  { format: 'markdown', label: 'Markdown', extension: 'md' },
  { format: 'latex', label: 'LaTeX', extension: 'tex' },
  { format: 'html', label: 'HTML', extension: 'html' },
  { format: 'csv', label: 'CSV', extension: 'csv' },
] as const;
export type TableFormat = (typeof kTableFormats)[number]['format'];

export const kUsualConditions = [
  'success_rate < baseline - 0.05',
  'median(position_rmse_m) > 1.1 * baseline',
];

export interface SweepResultsState {
  /** Names of files of published errors; null until read. */
  published: string[] | null;
  /** The one next to the tables; '' = none. */
  publishedName: string;
  /** ESTIMATOR=PUBLISHED_NAME, with commas between. */
  counterparts: string;
  /** The sweep to compare with; '' = none. */
  baseline: string;
  /** '' = all. */
  estimator: string;
  /** One a line. */
  conditions: string;
  comparing: boolean;
  /** The last comparison, or why there is none. */
  comparison: SweepComparison | string | null;
}

export function initialSweepResults(): SweepResultsState {
  return {
    published: null,
    publishedName: '',
    counterparts: '',
    baseline: '',
    estimator: '',
    conditions: kUsualConditions.join('\n'),
    comparing: false,
    comparison: null,
  };
}

export interface TableFile {
  fileName: string;
  content: Blob;
}

export class SweepResults {
  private asked = false;

  constructor(
    private readonly store: Store,
    private readonly client: Pick<SweepClient, 'compare' | 'files' | 'tables'>,
    private readonly notices: Pick<Notices, 'error'>,
  ) {}

  /** Once. */
  async readPublished(): Promise<void> {
    if (this.asked) return;
    this.asked = true;
    try {
      const { published } = await this.client.files();
      this.set({ published });
    } catch {
      // The tables can be saved without.
    }
  }

  set(changes: Partial<SweepResultsState>): void {
    Object.assign(this.state, changes);
    this.store.change('sweeps');
  }

  /** Says why there is none. */
  async table(name: string, format: TableFormat): Promise<TableFile | null> {
    const { publishedName, counterparts } = this.state;
    const query: Record<string, string> = { format };
    if (publishedName !== '') query.published = publishedName;
    const pairs = counterparts.replace(/\s/g, '');
    if (publishedName !== '' && pairs !== '') query.as = pairs;
    const extension = kTableFormats.find((one) => one.format === format)?.extension ?? 'txt';
    try {
      const content = await this.client.tables(name, query);
      return { fileName: `${name}.${extension}`, content };
    } catch (error) {
      this.notices.error(`The tables cannot be saved: ${errorText(error)}`);
      return null;
    }
  }

  async compare(name: string): Promise<void> {
    const asked = this.state;
    const { baseline, estimator, conditions, comparing } = asked;
    if (baseline === '' || comparing) return;
    this.set({ comparing: true });
    const lines = conditions.split('\n').map((line) => line.trim());
    const request = { baseline, estimator, conditions: lines.filter((line) => line !== '') };
    let comparison: SweepComparison | string;
    try {
      comparison = await this.client.compare(name, request);
    } catch (error) {
      comparison = errorText(error);
    }
    asked.comparing = false;
    const { state } = this;
    const shown = this.store.state.sweepPage.name === name;
    const same = state.baseline === baseline && state.estimator === estimator;
    this.set(shown && same ? { comparison } : {});
  }

  private get state(): SweepResultsState {
    return this.store.state.sweepPage.results;
  }
}
