import { describe, expect, it } from 'vitest';
import { following, windowAt, zoomed } from '../../src/store/time_window';

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

describe('windowAt', () => {
  const at = (t_s: number, playing = false) => ({ t_ns: t_s * 1e9, playing });

  it('shows what was zoomed to until the clock moves on', () => {
    const chosen = { span_s: [10, 20] as const, chosen_ns: 50e9, reached: true };
    expect(windowAt(chosen, whole, at(50))).toBe(chosen);
    expect(windowAt(chosen, whole, at(51)).span_s).toEqual([50, 60]);
  });

  it('does not follow the clock on its way to the time of an address', () => {
    const linked = { span_s: [10, 20] as const, chosen_ns: 50e9, reached: false };
    expect(windowAt(linked, whole, at(0))).toBe(linked);
    const there = windowAt(linked, whole, at(50));
    expect(there.span_s).toEqual([10, 20]);
    expect(windowAt(there, whole, at(0)).span_s).toEqual([0, 10]);
    expect(windowAt(linked, whole, at(30, true)).span_s, 'it plays').toEqual([29, 39]);
  });

  it('follows from then on, and stays the same object while nothing changes', () => {
    const free = { span_s: [10, 20] as const, chosen_ns: null, reached: true };
    expect(windowAt(free, whole, at(15))).toBe(free);
    expect(windowAt(free, whole, at(21)).span_s).toEqual([20, 30]);
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
