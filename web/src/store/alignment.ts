// The alignment of the estimates: chosen by the viewer, computed by the server, used in all views.
import type { RestClient } from '../connection/rest_client';
import { RestError } from '../connection/rest_error';
import type { Metrics } from '../protocol/rest_types';
import { alignmentModes, allMetrics, kDefaultAlignment } from './errors/error_table';
import type { Notices } from './notices';
import type { EstimateRows } from './run_data';
import { estimateRows } from './run_data';
import type { Session } from './session';
import { shownAlignment } from './state';
import type { Store } from './state';
import type { WatchedRun } from './watched_run';

/**
 * Whether the score contains the transform of this alignment, so that estimates can be drawn by it.
 */
export function canBeDrawn(metrics: Metrics | null, mode: string): boolean {
  if (mode === kDefaultAlignment) return true;
  return Object.values(metrics?.estimators ?? {}).some(
    ({ alignments }) => typeof alignments?.[mode]?.S_world_vo === 'object',
  );
}

export class Alignment {
  private readonly tried = new Set<string>();

  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
    private readonly session: Session,
    private readonly notices: Notices,
  ) {}

  async choose(mode: string): Promise<void> {
    this.store.state.alignment = mode;
    this.tried.clear();
    this.store.change('metrics');
    await this.refresh();
  }

  /** Draws the estimates a second time, by another alignment; null = no longer. */
  async compare(mode: string | null): Promise<void> {
    this.store.state.compared = mode;
    this.tried.clear();
    this.store.change('metrics', 'rows');
    await this.refresh();
  }

  /** Draws every watched run by the chosen alignments, where its score permits. */
  async refresh(): Promise<void> {
    const { watched } = this.store.state;
    this.leaveUnknown();
    await Promise.all(watched.flatMap((one) => [this.refreshRun(one), this.refreshCompared(one)]));
  }

  /** The scores say which alignments there are; a link may name others. */
  private leaveUnknown(): void {
    const { state } = this.store;
    const modes = alignmentModes(allMetrics(state.watched));
    const [first] = modes;
    if (first === undefined) return;
    if (!modes.includes(state.alignment)) state.alignment = first;
    if (state.compared !== null && !modes.includes(state.compared)) state.compared = null;
  }

  private async refreshRun(watched: WatchedRun): Promise<void> {
    const { state } = this.store;
    const { metrics, id } = watched;
    const mode = canBeDrawn(metrics, state.alignment) ? state.alignment : kDefaultAlignment;
    if (metrics === null || mode === shownAlignment(watched)) return;
    if (mode === kDefaultAlignment) {
      watched.aligned = null;
      this.apply(id, mode);
      return;
    }
    const attempt = `${id}/${mode}`;
    if (this.tried.has(attempt)) return;
    this.tried.add(attempt);
    const estimates = await this.placed(watched, mode);
    if (state.watchedRun(id) !== watched || state.alignment !== mode) return;
    if (estimates.size === 0) return;
    this.tried.delete(attempt);
    watched.aligned = { mode, estimates };
    this.apply(id, mode);
  }

  private async refreshCompared(watched: WatchedRun): Promise<void> {
    const { state } = this.store;
    const { metrics, id, data, compared } = watched;
    const mode = state.compared;
    if (mode === (compared?.mode ?? null)) return;
    const take = (estimates: Map<string, EstimateRows> | null) => {
      watched.compared = mode === null || estimates === null ? null : { mode, estimates };
      this.store.change('rows', 'metrics');
    };
    // What another alignment drew does not stay.
    if (mode === null || compared !== null) take(null);
    if (mode === null) return;
    if (mode === kDefaultAlignment) {
      take(data.estimates);
      return;
    }
    const attempt = `${id}/${mode} compared`;
    if (!canBeDrawn(metrics, mode) || this.tried.has(attempt)) return;
    this.tried.add(attempt);
    const estimates = await this.placed(watched, mode);
    if (state.watchedRun(id) !== watched || state.compared !== mode) return;
    if (estimates.size === 0) return;
    this.tried.delete(attempt);
    take(estimates);
  }

  private async placed(watched: WatchedRun, mode: string): Promise<Map<string, EstimateRows>> {
    const { id, metrics } = watched;
    const names = watched.run?.estimators ?? Object.keys(metrics?.estimators ?? {});
    const placed = await Promise.all(
      names.map(async (name) => [name, await this.place(id, name, mode)] as const),
    );
    return new Map(placed.flatMap(([name, rows]) => (rows ? [[name, rows]] : [])));
  }

  private apply(run: string, mode: string): void {
    this.session.command({ type: 'align', run, mode });
    this.store.change('rows', 'metrics', 'scene');
  }

  /** null if this estimate has no such alignment. */
  private async place(run: string, name: string, mode: string) {
    try {
      return estimateRows(await this.rest.estimate(run, name, mode));
    } catch (error) {
      const refused = error instanceof RestError && error.status === 409;
      if (!refused) this.notices.error(`Estimate ${name} by ${mode}: ${String(error)}`);
      return null;
    }
  }
}
