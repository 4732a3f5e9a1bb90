import { describe, expect, it } from 'vitest';
import {
  filterChoices,
  filtered,
  isFiltering,
  kNoFilter,
} from '../../../src/store/runs/run_filter';
import { sampleRun } from '../../support/samples';

const result = (estimator: string, outcome: string) => {
  return { estimator, outcome, position_rmse_m: 1, position_rmse_percent: null };
};
const runs = [
  sampleRun({
    id: 'a',
    estimators: ['feature', 'process'],
    results: [result('feature', 'COMPLETED'), result('process', 'LOST')],
    tags: ['wind'],
  }),
  sampleRun({ id: 'b', results: [result('feature', 'LOST')], scenario: 'hills' }),
  sampleRun({ id: 'c', status: 'failed', results: [result('feature', 'LOST')] }),
];
const ids = (filter: Partial<typeof kNoFilter>) =>
  filtered(runs, { ...kNoFilter, ...filter }).map(({ id }) => id);

describe('filtered', () => {
  it('passes everything without a filter', () => {
    expect(ids({})).toEqual(['a', 'b', 'c']);
    expect(isFiltering(kNoFilter)).toBe(false);
  });

  it('takes the outcome of the chosen estimator, else of any', () => {
    expect(ids({ outcome: 'LOST' })).toEqual(['a', 'b']);
    expect(ids({ outcome: 'LOST', estimator: 'feature' })).toEqual(['b']);
    expect(ids({ estimator: 'process' })).toEqual(['a']);
    expect(ids({ outcome: 'failed' })).toEqual(['c']);
  });

  it('takes scenario and tag exactly', () => {
    expect(ids({ scenario: 'hills' })).toEqual(['b']);
    expect(ids({ tag: 'win' })).toEqual([]);
    expect(ids({ tag: 'wind' })).toEqual(['a']);
  });
});

describe('filterChoices', () => {
  it('counts the runs that have a value', () => {
    const { estimator, outcome, scenario, tag } = filterChoices(runs);
    expect(estimator).toEqual([
      { value: 'feature', runs: 3 },
      { value: 'process', runs: 1 },
    ]);
    expect(outcome.map(({ value, runs: count }) => `${value} ${count}`)).toEqual([
      'COMPLETED 1',
      'failed 1',
      'LOST 2',
    ]);
    expect(scenario.map(({ value }) => value)).toEqual(['course', 'hills']);
    expect(tag).toEqual([{ value: 'wind', runs: 1 }]);
  });
});
