import { expect, it } from 'vitest';
import type { SweepState } from '../../../src/protocol/sweep_types';
import { progressTexts } from '../../../src/views/sweeps/sweep_head';

const begun: SweepState = {
  sweep: {
    name: 's',
    title: '',
    estimators: ['feature'],
    repeats: 1,
    axes: [],
    flying: true,
    here: 'flying',
    envelope: null,
    problem: null,
    progress: { passed: 0, most: 4, flown: 0, failed: 0, spent_s: 0, left_s: null },
    changed_utc: '2026-01-02T03:04:05Z',
  },
  envelope: null,
  table: null,
};

it('has a last result only once there is one', () => {
  expect(progressTexts(begun)).toEqual(['0 of 4 flights', 'no flight is over yet']);
  const { sweep } = begun;
  const progress = { passed: 1, most: 4, flown: 1, failed: 1, spent_s: 2, left_s: 6 };
  const table = { conventions: {}, failed: 1, unreadable: 0 } as unknown as SweepState['table'];
  const texts = progressTexts({ ...begun, sweep: { ...sweep, progress }, table });
  expect(texts[0]).toBe('1 of 4 flights');
  expect(texts).toContain('1 flights failed');
  expect(texts.at(-1)).toMatch(/^last result 2026-01-0/);
});
