import { describe, expect, it } from 'vitest';
import type { Curve } from '../../../src/store/plots/curve';
import { decimated } from '../../../src/store/plots/curve';
import { CurveWindow } from '../../../src/store/plots/curve_window';

const plain = { t_scale_s: 1, t_offset_s: 0, scale: 1, longest_gap_s: Infinity, wraps: false };

function sine(count: number): Curve {
  const t = Float64Array.from({ length: count }, (_, i) => i / 100);
  return { ...plain, t, values: t.map((t_s) => Math.sin(t_s)) };
}

describe('CurveWindow', () => {
  it('draws what would be drawn without it, wherever it is moved', () => {
    const window = new CurveWindow();
    const curve = sine(10_000);
    // Numbers without rounding, so that no point changes its interval.
    for (let begin_s = 16; begin_s < 70; begin_s += 3.75) {
      const span = [begin_s, begin_s + 16] as const;
      const line = window.at(curve, span, 128);
      expect(line.t_s.length).toBeLessThan(530);
      expect(line.t_s[0]).toBeLessThanOrEqual(span[0]);
      expect(line.t_s.at(-1)).toBeGreaterThanOrEqual(span[1]);
      const inside = ({ t_s, values }: typeof line) =>
        values.filter((_, i) => (t_s[i] ?? 0) > begin_s + 0.3 && (t_s[i] ?? 0) < begin_s + 15.7);
      expect(inside(line)).toEqual(inside(decimated(curve, span, 128)));
    }
  });

  it('shows values that were added', () => {
    const window = new CurveWindow();
    const all = sine(10_000);
    const first = (values: ArrayLike<number>) => (values as Float64Array).subarray(0, 100);
    const early = { ...all, t: first(all.t), values: first(all.values) };
    expect(window.at(early, [0, 100], 50).t_s.at(-1)).toBeCloseTo(0.99);
    expect(window.at(all, [0, 100], 50).t_s.at(-1)).toBeCloseTo(99.99);
  });

  it('shows other values, another offset and another scale', () => {
    const window = new CurveWindow();
    const curve = { ...sine(100), values: new Float64Array(100).fill(1) };
    expect(window.at(curve, [0, 1], 50).values[0]).toBe(1);
    expect(window.at({ ...curve, scale: 2 }, [0, 1], 50).values[0]).toBe(2);
    const other = { ...curve, values: new Float64Array(100).fill(7) };
    expect(window.at(other, [0, 1], 50).values[0]).toBe(7);
    expect(window.at({ ...other, t_offset_s: 0.5 }, [0, 1], 50).t_s[0]).toBe(0.5);
  });

  it('is finer when it is zoomed', () => {
    const window = new CurveWindow();
    const curve = sine(10_000);
    const far = window.at(curve, [0, 100], 50).t_s.filter((t_s) => t_s < 10).length;
    const near = window.at(curve, [0, 10], 50).t_s.length;
    expect(near).toBeGreaterThan(4 * far);
  });

  it('is empty without values', () => {
    expect(new CurveWindow().at({ ...plain, t: [], values: [] }, [0, 1], 9).t_s).toEqual([]);
  });
});
