import { describe, expect, it } from 'vitest';
import type { EstimatorResult } from '../../../src/protocol/rest_types';
import { bestFirst, leastError_m, ordered } from '../../../src/store/runs/run_order';
import { sampleRun } from '../../support/samples';

function result(estimator: string, position_rmse_m: number | null): EstimatorResult {
  return { estimator, outcome: 'COMPLETED', position_rmse_m, position_rmse_percent: null };
}

const runs = [
  sampleRun({ id: 'a', title: 'Course 10', results: [result('x', 2), result('y', 5)] }),
  sampleRun({ id: 'b', title: 'Course 9', results: [result('x', null)] }),
  sampleRun({ id: 'c', title: '', scenario: 'autzen', results: [result('x', 1)] }),
  sampleRun({ id: 'd', title: 'Course 10', results: [] }),
  sampleRun({ id: 'e', title: 'Beach', results: [result('x', 2)] }),
];

describe('leastError_m', () => {
  it('is of a flight that reached its end', () => {
    const results = [result('x', 2)];
    expect(leastError_m(sampleRun({ results }))).toBe(2);
    expect(leastError_m(sampleRun({ results, status: 'cancelled' }))).toBeNull();
  });
});

describe('ordered', () => {
  it.each([
    ['newest', 'abcde'],
    ['smallest-error', 'caebd'],
    ['largest-error', 'aecbd'],
    ['name', 'cebad'],
  ] as const)('%s', (order, ids) => {
    expect(
      ordered(runs, order)
        .map(({ id }) => id)
        .join(''),
    ).toBe(ids);
  });

  it('leaves the given list as it is', () => {
    ordered(runs, 'name');
    expect(runs.map(({ id }) => id).join('')).toBe('abcde');
  });
});

describe('leastError_m', () => {
  it('is that of the best estimator', () => {
    expect(runs.map(leastError_m)).toEqual([2, null, 1, null, 2]);
  });
});

describe('bestFirst', () => {
  it('puts estimators without an error last', () => {
    const results = [
      result('none', null),
      result('b', 3),
      result('also none', null),
      result('a', 1),
    ];
    expect(bestFirst(results).map(({ estimator }) => estimator)).toEqual([
      'a',
      'b',
      'none',
      'also none',
    ]);
  });
});
