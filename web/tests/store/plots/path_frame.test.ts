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
    const frame = fitted({ min: [0, -100], max: [100, 300] }, size);
    expect(frame.centre_m).toEqual([50, 100]);
    expect(frame.m_per_px).toBeCloseTo((400 * 1.12) / 200);
    const [, top] = toPixels(frame, size, [0, 300]);
    expect(top).toBeGreaterThan(0);
    const [x0, y0] = toPixels(frame, size, [0, 0]);
    const [x1, y1] = toPixels(frame, size, [10, 10]);
    expect(x1 - x0).toBeCloseTo(y0 - y1);
  });

  it('is not empty for a standing aircraft', () => {
    expect(fitted({ min: [5, 5], max: [5, 5] }, size).m_per_px).toBeGreaterThan(0);
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
  });
});

describe('boxOf', () => {
  it('leaves out what is not known', () => {
    expect(boxOf([{ x: [1, NaN, 3], y: [4, 5, -6] }])).toEqual({ min: [1, -6], max: [3, 4] });
    expect(boxOf([{ x: [NaN], y: [1] }])).toBeNull();
    expect(boxOf([])).toBeNull();
  });
});
