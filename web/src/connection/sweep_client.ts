// The REST calls about sweeps.
import type { JsonObject } from '../protocol/rest_types';
import type {
  ComparisonRequest,
  SweepCheck,
  SweepComparison,
  SweepEntry,
  SweepFiles,
  SweepStart,
  SweepState,
} from '../protocol/sweep_types';
import type { RestClient } from './rest_client';

export class SweepClient {
  constructor(private readonly rest: RestClient) {}

  /** Those flown last first. */
  async sweeps(): Promise<SweepEntry[]> {
    return ((await this.rest.call('GET', '/sweeps')) as { sweeps: SweepEntry[] }).sweeps;
  }

  async sweep(name: string): Promise<SweepState> {
    return (await this.rest.call('GET', placeOf(name))) as SweepState;
  }

  /** The document of a sweep; its scenario is an absolute path. */
  async document(name: string): Promise<JsonObject> {
    return (await this.rest.call('GET', `${placeOf(name)}/document`)) as JsonObject;
  }

  async files(): Promise<SweepFiles> {
    return (await this.rest.call('GET', '/sweep-files')) as SweepFiles;
  }

  async file(name: string): Promise<JsonObject> {
    return (await this.rest.call('GET', `/sweep-files/${encodeURIComponent(name)}`)) as JsonObject;
  }

  /** The server stops checking when `signal` aborts. */
  async check(document: JsonObject, signal: AbortSignal): Promise<SweepCheck> {
    return (await this.rest.call('POST', '/sweep-check', { document }, {}, signal)) as SweepCheck;
  }

  async start(start: SweepStart): Promise<SweepEntry> {
    return (await this.rest.call('POST', '/sweeps', start)) as SweepEntry;
  }

  /**
   * @param changed  another document and number of flights at a time, and the border that is
   *   sought; {} = the sweep's own, every cell
   */
  async continue(name: string, changed: Partial<Omit<SweepStart, 'name'>>): Promise<SweepEntry> {
    return (await this.rest.call('POST', `${placeOf(name)}/continue`, changed)) as SweepEntry;
  }

  /** The tables of a sweep as a file. @param query  as of the route */
  async tables(name: string, query: Record<string, string>): Promise<Blob> {
    return this.rest.file(`${placeOf(name)}/tables?${new URLSearchParams(query).toString()}`);
  }

  async compare(name: string, request: ComparisonRequest): Promise<SweepComparison> {
    return (await this.rest.call(
      'POST',
      `${placeOf(name)}/comparison`,
      request,
    )) as SweepComparison;
  }

  /** With the runs of its flights. */
  async remove(name: string): Promise<void> {
    await this.rest.call('DELETE', placeOf(name));
  }

  async cancel(name: string): Promise<SweepEntry> {
    return (await this.rest.call('POST', `${placeOf(name)}/cancel`)) as SweepEntry;
  }
}

function placeOf(name: string): string {
  return `/sweeps/${encodeURIComponent(name)}`;
}
