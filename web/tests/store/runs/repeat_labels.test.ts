import { expect, it } from 'vitest';
import { repeatLabels } from '../../../src/store/runs/repeat_labels';
import { summaryOf } from '../../../src/store/runs/repeats';

it('every outcome has a line of its own: together they are wider than the labels have room', () => {
  const outcomes: [string, number][] = [
    ['COMPLETED', 122],
    ['LOST', 13],
    ['NOT_INITIALISED', 1],
  ];
  expect(repeatLabels({ estimator: 'x', outcomes, summary: summaryOf([1, 3]) })).toEqual([
    'x',
    '122 COMPLETED',
    '13 LOST',
    '1 NOT_INITIALISED',
    'median 2.000 m',
  ]);
  expect(repeatLabels({ estimator: 'x', outcomes: [], summary: null })).toEqual(['x', 'no error']);
});
