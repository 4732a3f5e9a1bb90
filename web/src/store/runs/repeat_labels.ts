// What stands next to the errors of an estimator over repeated flights.
import { formatNumber } from '../format';
import type { Repeats } from './repeats';

/** One a line, the estimator first. */
export function repeatLabels({
  estimator,
  outcomes,
  summary,
}: Pick<Repeats, 'estimator' | 'outcomes' | 'summary'>): string[] {
  return [
    estimator,
    ...outcomes.map(([outcome, count]) => `${count} ${outcome}`),
    summary === null ? 'no error' : `median ${formatNumber(summary.median, 3)} m`,
  ];
}
