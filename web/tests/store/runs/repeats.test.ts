import { describe, expect, it } from 'vitest';
import type { EstimatorResult } from '../../../src/protocol/rest_types';
import {
  kAllRuns,
  kSameFlight,
  repeatChoices,
  repeatedRuns,
  repeatsOf,
  summaryOf,
} from '../../../src/store/runs/repeats';
import { sampleRun } from '../../support/samples';

function result(estimator: string, position_rmse_m: number | null): EstimatorResult {
  const outcome = position_rmse_m === null ? 'LOST' : 'COMPLETED';
  return { estimator, outcome, position_rmse_m, position_rmse_percent: null };
}

const runs = [
  sampleRun({ id: 'a', seed: 1, results: [result('x', 3), result('b', 1)], tags: ['night'] }),
  sampleRun({ id: 'b', seed: 2, results: [result('x', 1)] }),
  sampleRun({ id: 'c', seed: 3, results: [result('x', null)], tags: ['night'] }),
  sampleRun({ id: 'd', flight: 'another', results: [result('x', 9)] }),
];

describe('summaryOf', () => {
  it('has the quartiles of numpy.percentile', () => {
    // numpy.percentile([1, 2, 4, 8, 16, 32], [0, 25, 50, 75, 100])
    expect(summaryOf([1, 2, 4, 8, 16, 32])).toEqual({
      least: 1,
      q1: 2.5,
      median: 6,
      q3: 14,
      most: 32,
    });
    expect(summaryOf([7])).toEqual({ least: 7, q1: 7, median: 7, q3: 7, most: 7 });
    expect(summaryOf([])).toBeNull();
  });
});

describe('repeatedRuns', () => {
  const ids = (choice: string, main = runs[0] ?? null) =>
    repeatedRuns(runs, choice, main).map(({ id }) => id);

  it('are those of the same flight, of a tag, or all', () => {
    expect(ids(kSameFlight)).toEqual(['a', 'b', 'c']);
    expect(ids(kSameFlight, null)).toEqual([]);
    expect(ids('tag:night')).toEqual(['a', 'c']);
    expect(ids(kAllRuns)).toHaveLength(4);
  });

  it('are chosen by name', () => {
    expect(repeatChoices(runs).map(({ label }) => label)).toEqual([
      'Flights like the main run',
      'All runs',
      'Tag: night',
    ]);
  });
});

describe('repeatsOf', () => {
  it('counts outcomes and leaves flights without an error out of the quartiles', () => {
    const [b, x] = repeatsOf(runs.slice(0, 3));
    expect(b?.estimator).toBe('b');
    expect(x?.errors).toEqual([
      { run: 'b', error_m: 1 },
      { run: 'a', error_m: 3 },
    ]);
    expect(x?.summary?.median).toBe(2);
    expect(x?.outcomes).toEqual([
      ['COMPLETED', 2],
      ['LOST', 1],
    ]);
  });
});
