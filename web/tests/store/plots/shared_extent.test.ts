import { describe, expect, it } from 'vitest';
import { curveExtent, sharedExtent } from '../../../src/store/plots/shared_extent';

const truth = { low: [-10], high: [90], estimate: false };
const estimate = (low: number, high: number) => ({ low: [low], high: [high], estimate: true });

describe('sharedExtent', () => {
  it('encloses truth and estimates, also one that is far off', () => {
    expect(sharedExtent([truth, estimate(-900, 0), null, estimate(0, 95)], 2)).toEqual({
      low: [-900],
      high: [95],
      beyond: [],
    });
    expect(sharedExtent([null], 2)).toBeNull();
  });

  it('leaves out estimates that have diverged, whatever their order', () => {
    const list = [estimate(0, 3e12), truth, estimate(-5e5, 0), estimate(0, 100)];
    expect(sharedExtent(list, 2)).toEqual({ low: [-10], high: [100], beyond: [2, 0] });
  });

  it('shows a diverged estimate whole if nothing else is shown', () => {
    expect(sharedExtent([estimate(0, 3e12)], 2)).toEqual({ low: [0], high: [3e12], beyond: [] });
  });

  it('keeps large errors next to small ones, without a truth, but not those of a diverged one', () => {
    const good = estimate(0, 0.05);
    expect(sharedExtent([good, estimate(0, 698)], 0.1)?.beyond).toEqual([]);
    expect(sharedExtent([good, estimate(0, 698), estimate(0, 1e9)], 0.1)).toEqual({
      low: [0],
      high: [698],
      beyond: [2],
    });
  });

  it('never leaves out what is no estimate', () => {
    expect(sharedExtent([truth, { ...truth, high: [1e9] }], 2)?.high).toEqual([1e9]);
  });

  it('judges by the longest of several axes', () => {
    const level = { low: [0, 0, 100], high: [500, 900, 100], estimate: false };
    const low = { low: [0, 0, 20], high: [500, 900, 100], estimate: true };
    expect(sharedExtent([level, low], 2)?.low).toEqual([0, 0, 20]);
  });
});

describe('curveExtent', () => {
  it('counts known values in the span only', () => {
    const line = { t_s: [0, 1, 2, 3], values: [-50, 1, NaN, 4] };
    expect(curveExtent(line, [0.5, 3], true)).toEqual({ low: [1], high: [4], estimate: true });
    expect(curveExtent(line, [1.5, 2.5], true)).toBeNull();
  });
});
