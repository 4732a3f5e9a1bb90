// What the outcome of an estimator says, given how its flight ended.
import { isActive } from '../../protocol/rest_types';
import { kNothing } from '../format';
import type { WatchedRun } from '../watched_run';
import type { ErrorTable } from './error_table';

export interface RunOutcome {
  text: string;
  /** null = neither: not scored, or the flight did not reach its end. */
  good: boolean | null;
}

export const kReading = 'reading …';

export function runOutcome(
  { run, instant }: Pick<WatchedRun, 'run' | 'instant'>,
  { outcome, good }: ErrorTable['estimators'][number],
): RunOutcome {
  const scored = outcome !== kNothing;
  if (run !== null && !isActive(run) && run.status !== 'completed') {
    if (run.frames === 0) return { text: 'not flown', good: null };
    const ended = `flight ${run.status}`;
    return { text: scored ? `${outcome}, ${ended}` : ended, good: null };
  }
  if (scored) return { text: outcome, good };
  // The score of a run comes before its first instant.
  return { text: instant === null ? kReading : 'not scored yet', good: null };
}
