// Filters a list of runs by what the runs in it have.
import type { Run } from '../../protocol/rest_types';
import { countedResults } from './counted_results';
import { knownTags } from './run_tags';

/** '' = any. */
export interface RunFilter {
  estimator: string;
  /** How an estimator performed, or the status of a run that is not completed. */
  outcome: string;
  scenario: string;
  tag: string;
}

export type FilterField = keyof RunFilter;

export const kNoFilter: RunFilter = { estimator: '', outcome: '', scenario: '', tag: '' };

export interface FilterChoice {
  value: string;
  /** Number of runs that have it. */
  runs: number;
}

export function isFiltering(filter: RunFilter): boolean {
  return Object.values(filter).some((value) => value !== '');
}

/** With an estimator and an outcome, the runs in which that estimator had it. */
export function filtered(runs: readonly Run[], filter: RunFilter): Run[] {
  const { estimator, outcome, scenario, tag } = filter;
  return runs.filter(
    (run) =>
      (estimator === '' || run.estimators.includes(estimator)) &&
      (outcome === '' || outcomesOf(run, estimator).includes(outcome)) &&
      (scenario === '' || run.scenario === scenario) &&
      (tag === '' || run.tags.includes(tag)),
  );
}

/** What the runs have, by name. */
export function filterChoices(runs: readonly Run[]): Record<FilterField, FilterChoice[]> {
  return {
    estimator: counted(runs.map(({ estimators }) => estimators)),
    outcome: counted(runs.map((run) => outcomesOf(run, ''))),
    scenario: counted(runs.map(({ scenario }) => [scenario])),
    tag: knownTags(runs).map((value) => ({
      value,
      runs: runs.filter(({ tags }) => tags.includes(value)).length,
    })),
  };
}

function outcomesOf(run: Run, estimator: string): string[] {
  if (run.status !== 'completed') return [run.status];
  return countedResults(run)
    .filter((one) => estimator === '' || one.estimator === estimator)
    .map(({ outcome }) => outcome);
}

function counted(values: readonly (readonly string[])[]): FilterChoice[] {
  const counts = new Map<string, number>();
  for (const own of values) {
    for (const value of new Set(own)) counts.set(value, (counts.get(value) ?? 0) + 1);
  }
  return [...counts]
    .map(([value, runs]) => ({ value, runs }))
    .sort((a, b) => a.value.localeCompare(b.value, undefined, { numeric: true }));
}
