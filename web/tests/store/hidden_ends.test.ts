import { expect, it } from 'vitest';
import { hiddenEnds } from '../../src/store/hidden_ends';

it.each([
  [0, 100, false, false],
  [0, 101, false, false],
  [0, 140, false, true],
  [20, 140, true, true],
  [39.4, 140, true, false],
])('scrolled by %f of %f px', (scrollLeft, scrollWidth, left, right) => {
  expect(hiddenEnds({ scrollLeft, clientWidth: 100, scrollWidth })).toEqual({ left, right });
});
