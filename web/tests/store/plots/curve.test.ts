import { describe, expect, it } from 'vitest';
import type { Curve } from '../../../src/store/plots/curve';
import { decimated, valueAt } from '../../../src/store/plots/curve';

function curve(t_s: number[], values: number[], change: Partial<Curve> = {}): Curve {
  const plain = { t_scale_s: 1, t_offset_s: 0, scale: 1, longest_gap_s: Infinity, wraps: false };
  return { ...plain, t: t_s, values, ...change };
}

const every = (step_s: number, count: number, begin_s = 0) =>
  Array.from({ length: count }, (_, i) => begin_s + i * step_s);

describe('decimated', () => {
  it('keeps all points of a short curve, by the clock and in the shown unit', () => {
    const line = decimated(
      curve([1e9, 2e9], [0.01, 0.02], { t_scale_s: 1e-9, t_offset_s: 10, scale: 100 }),
      [0, 20],
      100,
    );
    expect(line.t_s).toEqual([11, 12]);
    expect(line.values).toEqual([1, 2]);
  });

  it('keeps the extremes of every interval, with few points', () => {
    const t_s = every(0.001, 100_000);
    const values = t_s.map((t, i) => (i === 31_234 ? 50 : i === 77_777 ? -50 : Math.sin(t)));
    const line = decimated(curve(t_s, values), [0, 100], 500);
    expect(line.values.length).toBeLessThanOrEqual(4 * 502);
    expect(Math.max(...line.values)).toBe(50);
    expect(line.t_s[line.values.indexOf(-50)]).toBeCloseTo(77.777);
    for (const [k] of line.t_s.entries()) {
      if (k > 0) expect(line.t_s[k]).toBeGreaterThanOrEqual(line.t_s[k - 1] ?? 0);
    }
    for (let i = 0; i < 500; i += 1) {
      const inside = values.slice(i * 200, (i + 1) * 200);
      const drawn = line.values.filter((_, k) => Math.floor((line.t_s[k] ?? 0) * 5) === i);
      expect(Math.max(...drawn)).toBeGreaterThanOrEqual(Math.max(...inside) - 1e-3);
      expect(Math.min(...drawn)).toBeLessThanOrEqual(Math.min(...inside) + 1e-3);
    }
  });

  it('reaches from one point before the span to one after it', () => {
    const line = decimated(curve(every(1, 100), every(1, 100)), [10.5, 12.5], 100);
    expect(line.t_s).toEqual([10, 11, 12, 13]);
  });

  it('keeps the shape of a curve that is moved', () => {
    const t_s = every(0.01, 10_000);
    const noise = curve(
      t_s,
      t_s.map((t) => Math.sin(1e5 * t)),
    );
    const inside = (begin_s: number) => {
      const { t_s: drawn_s, values } = decimated(noise, [begin_s, begin_s + 50], 100);
      return values.filter((_, k) => (drawn_s[k] ?? 0) > 25 && (drawn_s[k] ?? 0) < 45);
    };
    expect(inside(10.37)).toEqual(inside(0));
  });

  it('breaks where there is no value, at a gap, and where an angle wraps', () => {
    expect(decimated(curve([0, 1, 2], [5, NaN, 6]), [0, 2], 100).values).toEqual([5, NaN, 6]);
    const gap = decimated(curve([0, 1, 9], [5, 6, 7], { longest_gap_s: 3 }), [0, 9], 100);
    expect(gap).toEqual({ t_s: [0, 1, 5, 9], values: [5, 6, NaN, 7] });
    const wrap = decimated(curve([0, 1, 2], [170, 179, -179], { wraps: true }), [0, 2], 100);
    expect(wrap.values).toEqual([170, 179, NaN, -179]);
    const same = decimated(curve([0, 1, 2], [170, 179, -179]), [0, 2], 100);
    expect(same.values).toEqual([170, 179, -179]);
  });

  it('draws no line across the wrap of a long curve either', () => {
    const t_s = every(0.01, 10_000);
    const values = t_s.map((t) => ((36 * t + 180) % 360) - 180);
    const line = decimated(curve(t_s, values, { wraps: true }), [0, 100], 100);
    line.values.forEach((value, i) => {
      expect(Math.abs(value - (line.values[i - 1] ?? value)) > 180).toBe(false);
    });
    expect(line.values.filter(Number.isNaN)).toHaveLength(10);
  });

  it('is empty without points', () => {
    expect(decimated(curve([], []), [0, 1], 10)).toEqual({ t_s: [], values: [] });
  });
});

describe('valueAt', () => {
  it('is the latest value, in the shown unit', () => {
    const degrees = curve([0, 1, 2], [1, 2, 3], { scale: 10, t_offset_s: 5 });
    expect(valueAt(degrees, 6.7)).toBe(20);
    expect(valueAt(degrees, 4)).toBeNaN();
    expect(valueAt(curve([1e9 / 31], [4], { t_scale_s: 1e-9 }), 1 / 31)).toBe(4);
  });

  it('is none in a gap', () => {
    const t_s = [...every(1, 10), ...every(1, 10, 100)];
    const paused = curve(t_s, t_s, { longest_gap_s: 5 });
    expect(valueAt(paused, 50)).toBeNaN();
    expect(valueAt(paused, 105)).toBe(105);
  });
});
