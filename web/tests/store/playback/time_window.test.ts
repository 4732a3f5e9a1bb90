import { describe, expect, it } from 'vitest';
import { following, follows, panned, zoomed } from '../../../src/store/playback/time_window';

const whole = [0, 100] as const;

describe('zoomed', () => {
  it('keeps the time under the mouse where it is', () => {
    expect(zoomed(whole, whole, 20, 0.5)).toEqual([10, 60]);
  });

  it('stays inside the flight and ends at all of it', () => {
    expect(zoomed([0, 50], whole, 50, 1.5)).toEqual([0, 75]);
    expect(zoomed([10, 90], whole, 50, 2)).toBeNull();
  });

  it('goes no closer than half a second', () => {
    expect(zoomed([10, 10.6], whole, 10.3, 0.5)).toEqual([10, 10.6]);
  });
});

describe('following', () => {
  it('moves on only when the cursor leaves', () => {
    expect(following([10, 20], whole, 15)).toEqual([10, 20]);
    expect(following([10, 20], whole, 21)).toEqual([20, 30]);
    expect(following([10, 20], whole, 5)).toEqual([0, 10]);
    expect(following([10, 20], whole, 100)).toEqual([90, 100]);
  });
});

describe('panned', () => {
  it('keeps its width and stays inside the flight', () => {
    expect(panned([10, 20], whole, 5)).toEqual([15, 25]);
    expect(panned([10, 20], whole, -50)).toEqual([0, 10]);
    expect(panned([10, 20], whole, 500)).toEqual([90, 100]);
  });
});

describe('follows', () => {
  it('goes with a clock that was in the window', () => {
    expect(follows([10, 20], 19.9, 20.1, 1)).toBe(true);
    expect(follows([10, 20], 15, 15, 1)).toBe(false);
  });

  it('goes to a clock elsewhere only when it jumps, which depends on the speed', () => {
    expect(follows([10, 20], 50, 50.1, 1)).toBe(false);
    expect(follows([10, 20], 50, 52, 1)).toBe(true);
    expect(follows([10, 20], 50, 52, -50)).toBe(false);
  });
});
