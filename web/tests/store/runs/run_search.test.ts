import { describe, expect, it } from 'vitest';
import { matching } from '../../../src/store/runs/run_search';
import { sampleRun } from '../../support/samples';

const runs = [
  sampleRun({ id: 'a', title: 'Hills at 25 m/s', estimators: ['feature'], flight: 'log smooth' }),
  sampleRun({
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
  ])('finds by %j', (text, ids) => {
    expect(matching(runs, text).map(({ id }) => id)).toEqual(ids);
  });
});
