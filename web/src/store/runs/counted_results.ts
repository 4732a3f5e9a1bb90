// Which results of runs say how estimators perform.
import type { EstimatorResult, Run, RunStatus } from '../../protocol/rest_types';
import { isActive } from '../../protocol/rest_types';

/** None of a flight that did not reach its end: it says nothing about the estimators. */
export function countedResults({ status, results }: Run): EstimatorResult[] {
  return status === 'completed' ? results : [];
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
