import { describe, expect, it } from 'vitest';
import { paddedRange } from '../../../src/store/plots/plot_range';

describe('paddedRange', () => {
  it('leaves air around the data', () => {
    const [low, high] = paddedRange(0, 100, 2);
    expect(low).toBeCloseTo(-6);
    expect(high).toBeCloseTo(106);
  });

  it('is wide enough for a constant, and for nothing at all', () => {
    expect(paddedRange(5, 5, 2)).toEqual([4, 6]);
    expect(paddedRange(Infinity, -Infinity, 2)).toEqual([-1, 1]);
  });
});
