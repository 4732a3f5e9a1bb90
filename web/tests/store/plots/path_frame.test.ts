import { describe, expect, it } from 'vitest';
import {
  boxOf,
  fitted,
  ticks,
  tickText,
  toMetres,
  toPixels,
  zoomedAt,
} from '../../../src/store/plots/path_frame';

const size = { width_px: 400, height_px: 200 };

describe('a path frame', () => {
  it('shows the whole box with equal scales', () => {
    const frame = fitted({ low: [0, -100], high: [100, 300] }, size);
    expect(frame.centre_m).toEqual([50, 100]);
    expect(frame.m_per_px).toBeCloseTo((400 * 1.12) / 200);
    const [, top] = toPixels(frame, size, [0, 300]);
    expect(top).toBeGreaterThan(0);
    const [x0, y0] = toPixels(frame, size, [0, 0]);
    const [x1, y1] = toPixels(frame, size, [10, 10]);
    expect(x1 - x0).toBeCloseTo(y0 - y1);
  });

  it('is not empty for a standing aircraft', () => {
    expect(fitted({ low: [5, 5], high: [5, 5] }, size).m_per_px).toBeGreaterThan(0);
  });

  it('goes to pixels and back', () => {
    const frame = { centre_m: [12, -7] as [number, number], m_per_px: 0.25 };
    const [x, y] = toMetres(frame, size, toPixels(frame, size, [3.5, 9.25]));
    expect([x, y]).toEqual([3.5, 9.25]);
  });

  it('zooms about the point under the mouse', () => {
    const frame = { centre_m: [0, 0] as [number, number], m_per_px: 1 };
    const near = zoomedAt(frame, size, [300, 50], 0.5);
    expect(near.m_per_px).toBe(0.5);
    expect(toMetres(near, size, [300, 50])).toEqual(toMetres(frame, size, [300, 50]));
    const limited = zoomedAt(frame, size, [300, 50], 1e-9);
    expect(limited.m_per_px).toBe(1e-4);
    expect(toMetres(limited, size, [300, 50])[0]).toBeCloseTo(100);
  });
});

describe('ticks', () => {
  it.each([
    [0, 10, 5, [0, 2, 4, 6, 8, 10]],
    [-0.3, 0.31, 4, [-0.2, 0, 0.2]],
    [995, 1101, 3, [1000, 1050, 1100]],
    [1, 1, 3, []],
  ])('between %d and %d', (low, high, most, expected) => {
    const found = ticks(low, high, most);
    expect(found).toHaveLength(expected.length);
    found.forEach((tick, i) => expect(tick).toBeCloseTo(expected[i] ?? NaN));
  });

  it('have the digits of their step', () => {
    expect(tickText(0.2 * 3, 0.2)).toBe('0.6');
    expect(tickText(-50, 50)).toBe('−50');
    expect(tickText(-1e-12, 0.5)).toBe('0.0');
    expect(tickText(12000, 2000)).toBe('12000');
    expect(tickText(-1.5e12, 5e11)).toBe('−1.5e12');
    expect(tickText(120000, 10000)).toBe('1.2e5');
    expect(tickText(1e6, 2e5)).toBe('1.0e6');
    expect(tickText(0, 1e5)).toBe('0');
    expect(tickText(1e300, 1e5)).toBe('1.0000000000000001e300');
    expect(tickText(12.5, 2.5)).toBe('12.5');
    expect(tickText(0.75, 0.25)).toBe('0.75');
    expect(tickText(1.25e6, 2.5e5)).toBe('1.25e6');
  });
});

describe('boxOf', () => {
  const truth = { hue: { kind: 'truth', order: 0 } as const, x: [0, 100], y: [0, 50] };

  it('leaves out what is not known', () => {
    const { hue } = truth;
    expect(boxOf([{ hue, x: [1, NaN, 3], y: [4, 5, -6] }])).toMatchObject({
      low: [1, -6],
      high: [3, 4],
    });
    expect(boxOf([{ hue, x: [NaN], y: [1] }])).toBeNull();
    expect(boxOf([])).toBeNull();
  });

  it('leaves out an estimate that has diverged', () => {
    const diverged = { hue: { kind: 'estimate', colour: 0 } as const, x: [0, 1], y: [0, -2e12] };
    expect(boxOf([diverged, truth])).toEqual({ low: [0, 0], high: [100, 50], beyond: [0] });
    expect(boxOf([diverged])).toEqual({ low: [0, -2e12], high: [1, 0], beyond: [] });
  });
});
