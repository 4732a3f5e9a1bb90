// Repeated flights: how the errors of each estimator are distributed over them.
import type { Run } from '../../protocol/rest_types';
import { countedResults } from './counted_results';
import { knownTags } from './run_tags';

/** Which runs are compared: those that fly as the main run does, all of them, or those of a tag. */
export const kSameFlight = 'flight';
export const kAllRuns = 'all';
const kTag = 'tag:';

export interface RepeatChoice {
  value: string;
  label: string;
}

export interface RunError {
  run: string;
  error_m: number;
}

/** Quartiles interpolate linearly between the values, as NumPy's default does. */
export interface Summary {
  least: number;
  q1: number;
  median: number;
  q3: number;
  most: number;
}

/** One estimator over the runs. */
export interface Repeats {
  estimator: string;
  /** Position RMSE under alignment init_scale, of the flights that have one; ascending. */
  errors: RunError[];
  /** null without an error. */
  summary: Summary | null;
  /** Number of flights by outcome, the most frequent first. */
  outcomes: [string, number][];
}

export function repeatChoices(runs: readonly Run[]): RepeatChoice[] {
  return [
    { value: kSameFlight, label: 'Flights like the main run' },
    { value: kAllRuns, label: 'All runs' },
    ...knownTags(runs).map((tag) => ({ value: kTag + tag, label: `Tag: ${tag}` })),
  ];
}

/** Runs of a choice. @param main  null: no run is like it */
export function repeatedRuns(runs: readonly Run[], choice: string, main: Run | null): Run[] {
  if (choice === kAllRuns) return [...runs];
  if (choice.startsWith(kTag)) {
    const tag = choice.slice(kTag.length);
    return runs.filter(({ tags }) => tags.includes(tag));
  }
  return runs.filter(
    ({ scenario, title, flight }) =>
      main !== null && scenario === main.scenario && title === main.title && flight === main.flight,
  );
}

/** Of the completed runs, by estimator in alphabetical order. */
export function repeatsOf(runs: readonly Run[]): Repeats[] {
  const results = runs.flatMap((run) =>
    countedResults(run).map((result) => ({ run: run.id, result })),
  );
  const names = [...new Set(results.map(({ result }) => result.estimator))];
  return names
    .sort((a, b) => a.localeCompare(b))
    .map((estimator) => {
      const own = results.filter(({ result }) => result.estimator === estimator);
      const errors = own
        .flatMap(({ run, result }) =>
          result.position_rmse_m === null ? [] : [{ run, error_m: result.position_rmse_m }],
        )
        .sort((a, b) => a.error_m - b.error_m);
      return {
        estimator,
        errors,
        summary: summaryOf(errors.map(({ error_m }) => error_m)),
        outcomes: counted(own.map(({ result }) => result.outcome)),
      };
    });
}

/** @param values  ascending */
export function summaryOf(values: readonly number[]): Summary | null {
  const [least, most] = [values[0], values.at(-1)];
  if (least === undefined || most === undefined) return null;
  return {
    least,
    q1: quantile(values, 0.25),
    median: quantile(values, 0.5),
    q3: quantile(values, 0.75),
    most,
  };
}

function quantile(ascending: readonly number[], share: number): number {
  const at = share * (ascending.length - 1);
  const low = Math.floor(at);
  const below = ascending[low] ?? NaN;
  const above = ascending[Math.min(low + 1, ascending.length - 1)] ?? NaN;
  return below + (at - low) * (above - below);
}

function counted(texts: readonly string[]): [string, number][] {
  const counts = new Map<string, number>();
  for (const text of texts) counts.set(text, (counts.get(text) ?? 0) + 1);
  return [...counts].sort((a, b) => b[1] - a[1]);
}
