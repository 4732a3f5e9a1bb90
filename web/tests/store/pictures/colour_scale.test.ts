import { describe, expect, it } from 'vitest';
import { gradient, ticksOf } from '../../../src/store/pictures/colour_scale';

describe('the legend of a colour scale', () => {
  it('marks round values of a linear scale, both ends too if they are round', () => {
    const ticks = ticksOf({ low: 280, high: 360, logarithmic: false });
    expect(ticks.map(({ value }) => value)).toEqual([280, 300, 320, 340, 360]);
    expect(ticks.map(({ share }) => share)).toEqual([0, 0.25, 0.5, 0.75, 1]);
  });

  it('marks no more than asked for', () => {
    for (const high of [301, 333, 420, 777, 5000]) {
      const ticks = ticksOf({ low: 300, high, logarithmic: false });
      expect(ticks.length, `to ${high}`).toBeGreaterThan(0);
      expect(ticks.length, `to ${high}`).toBeLessThanOrEqual(5);
    }
  });

  it('marks zero of a scale of differences', () => {
    const ticks = ticksOf({ low: -32, high: 32, logarithmic: false });
    expect(ticks).toContainEqual({ value: 0, share: 0.5 });
  });

  it('places values of a logarithmic scale by their logarithm', () => {
    const ticks = ticksOf({ low: 200, high: 20000, logarithmic: true });
    expect(ticks.map(({ value }) => value)).toEqual([200, 1000, 5000, 20000]);
    expect(ticks[1]?.share).toBeCloseTo(Math.log(5) / Math.log(100), 9);
    expect(ticks.length).toBeLessThanOrEqual(5);
  });

  it('marks nothing of a scale without extent', () => {
    expect(ticksOf({ low: 0, high: 0, logarithmic: false })).toEqual([]);
  });

  it('runs from near to far, and from blue to orange', () => {
    expect(gradient('depth')).toMatch(/^linear-gradient\(to right, rgb\(250 237 161\)/);
    expect(gradient('error')).toMatch(/rgb\(255 166 85\)\)$/);
  });
});
