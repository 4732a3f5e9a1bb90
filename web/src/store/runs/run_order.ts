// The order of a list of runs.
import type { EstimatorResult, Run } from '../../protocol/rest_types';
import { countedResults } from './counted_results';

export const kRunOrders = {
  newest: 'Newest',
  'smallest-error': 'Smallest error',
  'largest-error': 'Largest error',
  name: 'Name',
} as const;

export type RunOrder = keyof typeof kRunOrders;

export function isRunOrder(text: string): text is RunOrder {
  return Object.hasOwn(kRunOrders, text);
}

/** The smallest position error of a completed run's estimators [m]; null if none has one. */
export function leastError_m(run: Run): number | null {
  const errors = countedResults(run).flatMap(({ position_rmse_m }) => position_rmse_m ?? []);
  return errors.length > 0 ? Math.min(...errors) : null;
}

/**
 * Runs in an order. The given order, newest first, decides between equals. Runs without an error
 * come last in both orders by error.
 */
export function ordered(runs: readonly Run[], order: RunOrder): Run[] {
  if (order === 'newest') return [...runs];
  if (order === 'name') {
    const nameOf = (run: Run) => run.title || run.scenario;
    return [...runs].sort((a, b) =>
      nameOf(a).localeCompare(nameOf(b), undefined, { numeric: true }),
    );
  }
  const sign = order === 'smallest-error' ? 1 : -1;
  const errors = new Map(runs.map((run) => [run, leastError_m(run)]));
  return [...runs].sort((a, b) => {
    const [left, right] = [errors.get(a) ?? null, errors.get(b) ?? null];
    if (left === null || right === null) return Number(left === null) - Number(right === null);
    return sign * (left - right);
  });
}

/** The best results first; those without an error last. */
export function bestFirst(results: readonly EstimatorResult[]): EstimatorResult[] {
  const rank = ({ position_rmse_m }: EstimatorResult) => position_rmse_m ?? Infinity;
  return [...results].sort((a, b) => (rank(a) === rank(b) ? 0 : rank(a) - rank(b)));
}
