import { describe, expect, it } from 'vitest';
import type { Polyline } from '../../../src/store/plots/curve';
import { traceLine } from '../../../src/store/plots/pixel_line';

const scale = { left: 10, top: 20, begin_s: 5, greatest: 3, px_per_s: 100, px_per_unit: 40 };

function traced(line: Polyline): { moves: number; points: [number, number][] } {
  const points: [number, number][] = [];
  let moves = 0;
  traceLine(line, scale, {
    moveTo: (x, y) => {
      moves += 1;
      points.push([x, y]);
    },
    lineTo: (x, y) => points.push([x, y]),
  });
  return { moves, points };
}

/** Height of the traced line at a pixel column. */
function heightAt(points: [number, number][], x: number): number {
  const next = points.findIndex(([at]) => at >= x);
  const [x1, y1] = points[next] ?? [NaN, NaN];
  const [x0, y0] = points[next - 1] ?? [x1, y1];
  return x1 === x0 ? y1 : y0 + ((x - x0) / (x1 - x0)) * (y1 - y0);
}

describe('traceLine', () => {
  it('places times and values', () => {
    expect(traced({ t_s: [5, 6], values: [3, 1] }).points.at(0)).toEqual([10, 20]);
    expect(traced({ t_s: [5, 6], values: [3, 1] }).points.at(-1)).toEqual([110, 100]);
  });

  it('places what a canvas cannot draw far outside of the plot', () => {
    const { points } = traced({ t_s: [5, 6, 7], values: [3, -2e12, 3e300] });
    expect(points.map(([, y]) => Math.abs(y) <= 100020)).toEqual([true, true, true]);
    expect(points[1]?.[1]).toBeGreaterThan(1e4);
    expect(points[2]?.[1]).toBeLessThan(-1e4);
  });

  it('draws a straight line by its ends', () => {
    const t_s = Array.from({ length: 1000 }, (_, i) => 5 + i / 100);
    expect(traced({ t_s, values: t_s.map((t) => 2 * t) }).points.length).toBeLessThanOrEqual(3);
  });

  it('passes every point nearer than a quarter of a pixel, with far fewer lines', () => {
    const t_s = Array.from({ length: 2000 }, (_, i) => 5 + i / 500);
    const values = t_s.map((t) => Math.sin(3 * t));
    const { points } = traced({ t_s, values });
    expect(points.length).toBeLessThan(200);
    t_s.forEach((t, i) => {
      const y = 20 + (3 - (values[i] ?? 0)) * 40;
      expect(Math.abs(heightAt(points, 10 + (t - 5) * 100) - y)).toBeLessThan(0.25);
    });
  });

  it('keeps every peak of noise', () => {
    const t_s = Array.from({ length: 500 }, (_, i) => 5 + i / 250);
    const values = t_s.map((_, i) => (i % 2 === 0 ? 1 : -1));
    expect(traced({ t_s, values }).points.length).toBeGreaterThanOrEqual(500);
  });

  it('breaks where there is no value, and draws single points', () => {
    const { moves, points } = traced({ t_s: [5, 6, 7], values: [1, NaN, 2] });
    expect(moves).toBe(2);
    expect(points.map(([x]) => Math.round(x))).toEqual([10, 10, 210, 210]);
  });
});
