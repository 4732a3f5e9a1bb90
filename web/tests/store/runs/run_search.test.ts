import { describe, expect, it } from 'vitest';
import { matching, searchFor } from '../../../src/store/runs/run_search';
import { sampleRun } from '../../support/samples';

const runs = [
  sampleRun({ id: 'a', title: 'Hills at 25 m/s', estimators: ['feature'], flight: 'log smooth' }),
  sampleRun({
    seed: 10,
    tags: ['for the paper', 'wind'],
    results: [
      { estimator: 'feature', outcome: 'LOST', position_rmse_m: 2, position_rmse_percent: null },
    ],
    id: 'b',
    title: 'Hills at 10 m/s',
    flight: '',
    texture_limited: true,
  }),
  sampleRun({
    id: 'c',
    title: 'Stopped',
    flight: '',
    status: 'cancelled',
    estimators: [],
    results: [
      { estimator: 'x', outcome: 'COMPLETED', position_rmse_m: 1, position_rmse_percent: null },
    ],
  }),
];

describe('matching', () => {
  it.each([
    ['', ['a', 'b', 'c']],
    ['  hills ', ['a', 'b']],
    ['HILLS 25', ['a']],
    ['cancelled', ['c']],
    ['smooth', ['a']],
    ['texture', ['b']],
    ['hills nothing', []],
    ['seed:1', ['a', 'c']],
    ['seed:10', ['b']],
    ['seed 10', ['b']],
    ['Outcome:lost', ['b']],
    // Only flights that reached their end have outcomes.
    ['outcome:completed', []],
    ['stopped completed', []],
    ['outcome:lost seed:1', []],
    ['estimator:feat', ['a', 'b']],
    ['status:completed tag:wind', ['b']],
    ['tag:"for the paper"', ['b']],
    ['"25 m/s"', ['a']],
    ['"m/s 25"', []],
    ['title:smooth', []],
    ['unknown:1', []],
    ['seed:', []],
    ['""', ['a', 'b', 'c']],
  ])('finds by %j', (text, ids) => {
    expect(matching(runs, text).map(({ id }) => id)).toEqual(ids);
  });
});

describe('fields that there are not', () => {
  it.each(['constructor:"x"', '__proto__:"x"', 'foo:"bar"', 'toString:x', ':"'])(
    'find nothing: %s',
    (text) => {
      expect(matching(runs, text)).toEqual([]);
    },
  );
});

describe('searchFor', () => {
  it('finds the field, whatever is in it', () => {
    expect(searchFor('tag', 'wind')).toBe('tag:wind');
    expect(matching(runs, searchFor('tag', 'for the paper')).map(({ id }) => id)).toEqual(['b']);
  });
});
