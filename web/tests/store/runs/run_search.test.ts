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
    status: 'failed',
    texture_limited: true,
  }),
];

describe('matching', () => {
  it.each([
    ['', ['a', 'b']],
    ['  hills ', ['a', 'b']],
    ['HILLS 25', ['a']],
    ['failed', ['b']],
    ['smooth', ['a']],
    ['texture', ['b']],
    ['hills nothing', []],
    ['seed:1', ['a']],
    ['seed:10', ['b']],
    ['seed 10', ['b']],
    ['Outcome:lost', ['b']],
    ['outcome:lost seed:1', []],
    ['estimator:feat', ['a', 'b']],
    ['status:failed tag:wind', ['b']],
    ['tag:"for the paper"', ['b']],
    ['"25 m/s"', ['a']],
    ['"m/s 25"', []],
    ['title:smooth', []],
    ['unknown:1', []],
    ['seed:', []],
    ['""', ['a', 'b']],
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
