import { describe, expect, it } from 'vitest';
import { valueTicks } from '../../../src/store/plots/value_ticks';

describe('the numbers of a value axis', () => {
  it('are round and some 20 pixels apart', () => {
    expect(valueTicks(0, 10, 100)).toEqual([0, 2, 4, 6, 8, 10]);
    expect(valueTicks(-1, 9, 60)).toEqual([0, 5]);
  });

  it('are nearer to each other in a low plot', () => {
    expect(valueTicks(-1.3, 9.4, 30)).toEqual([0, 5]);
  });

  it('are the least and the greatest where neighbours do not fit', () => {
    expect(valueTicks(-4.5, 4.5, 27)).toEqual([-4, 4]);
    expect(valueTicks(1.5, 8.5, 14)).toEqual([2, 8]);
  });

  it('are two at least in every plot', () => {
    for (let height_px = 10; height_px < 80; height_px += 1) {
      for (const [low, high] of [
        [-0.31, 5.27],
        [99.2, 101.7],
        [-181, 181],
        [0.012, 0.019],
      ] as const) {
        const values = valueTicks(low, high, height_px);
        expect(values.length).toBeGreaterThanOrEqual(2);
        for (const value of values) expect(value >= low && value <= high).toBe(true);
      }
    }
  });

  it('are missing without a range', () => {
    expect(valueTicks(5, 5, 60)).toEqual([]);
  });
});
