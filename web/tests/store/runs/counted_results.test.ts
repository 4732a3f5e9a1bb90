import { expect, it } from 'vitest';
import type { RunStatus } from '../../../src/protocol/rest_types';
import { countedResults, notCounted, withResults } from '../../../src/store/runs/counted_results';
import { repeatsOf } from '../../../src/store/runs/repeats';
import { failedEstimators } from '../../../src/store/studies/study_form';
import { sampleRun } from '../../support/samples';

const run = (status: RunStatus, outcome: string, position_rmse_m: number | null) =>
  sampleRun({
    id: `${status} ${outcome}`,
    status,
    results: [{ estimator: 'x', outcome, position_rmse_m, position_rmse_percent: null }],
  });
const runs = [
  run('completed', 'COMPLETED', 4),
  run('cancelled', 'COMPLETED', 1),
  run('failed', 'NOT_INITIALISED', null),
  run('failed', 'LOST', 2),
  run('running', 'LOST', null),
];

it('a flight that did not reach its end has no results that count', () => {
  expect(runs.map((one) => countedResults(one).length)).toEqual([1, 0, 0, 0, 0]);
});

it('a run of a sweep, which no list has, has the outcomes of its score', () => {
  const metrics = { estimators: { x: { outcome: 'LOST' }, y: { outcome: 'COMPLETED' } } };
  const ofSweep = withResults({ run: sampleRun(), metrics });
  expect(ofSweep === null ? [] : failedEstimators(ofSweep)).toEqual(['x']);
  expect(withResults({ run: sampleRun(), metrics: null })?.results).toEqual([]);
  const listed = run('completed', 'RESET', 4);
  expect(withResults({ run: listed, metrics })).toBe(listed);
  expect(withResults({ run: null, metrics })).toBeNull();
  expect(withResults(null)).toBeNull();
});

it('repeated flights are the completed ones, and the others are counted apart', () => {
  const [x] = repeatsOf(runs);
  expect(x?.errors).toEqual([{ run: 'completed COMPLETED', error_m: 4 }]);
  expect(x?.outcomes).toEqual([['COMPLETED', 1]]);
  expect(notCounted(runs)).toEqual([
    ['failed', 2],
    ['cancelled', 1],
  ]);
});
