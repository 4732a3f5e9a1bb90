// Which results of runs say how estimators perform.
import type { EstimatorResult, Run, RunStatus } from '../../protocol/rest_types';
import { isActive } from '../../protocol/rest_types';
import type { WatchedRun } from '../watched_run';

/** None of a flight that did not reach its end: it says nothing about the estimators. */
export function countedResults({ status, results }: Run): EstimatorResult[] {
  return status === 'completed' ? results : [];
}

/** A run with the outcomes of its score: no list has the results of runs of sweeps and studies. */
export function withResults(watched: Pick<WatchedRun, 'run' | 'metrics'> | null): Run | null {
  const run = watched?.run ?? null;
  if (run === null || run.results.length > 0) return run;
  const scores = Object.entries(watched?.metrics?.estimators ?? {});
  const results = scores.map(([estimator, { outcome }]) => ({
    estimator,
    outcome,
    position_rmse_m: null,
    position_rmse_percent: null,
  }));
  return { ...run, results };
}

/** Why the flights that ended otherwise did; the most frequent first. */
export function notCounted(runs: readonly Run[]): [RunStatus, number][] {
  const counts = new Map<RunStatus, number>();
  for (const run of runs) {
    const { status } = run;
    if (status === 'completed' || isActive(run)) continue;
    counts.set(status, (counts.get(status) ?? 0) + 1);
  }
  return [...counts].sort((a, b) => b[1] - a[1]);
}
