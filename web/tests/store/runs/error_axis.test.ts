import { describe, expect, it } from 'vitest';
import { axisTicks, errorAxis, histogram, placeOn } from '../../../src/store/runs/error_axis';

describe('errorAxis', () => {
  it('is linear from 0 for errors of one size', () => {
    const axis = errorAxis([1, 20]);
    expect(axis).toEqual({ logarithmic: false, low: 0, high: 21 });
    expect(placeOn(axis, 10.5)).toBe(0.5);
    expect(axisTicks(axis, 9)).toEqual([0, 5, 10, 15, 20]);
    expect(axisTicks(axis, 2.5)).toEqual([0, 20]);
    expect(histogram(axis, [1, 2, 20], 3)).toEqual([2, 0, 1]);
  });

  it('is logarithmic between powers of ten for others', () => {
    const axis = errorAxis([0.02, 300]);
    expect(axis).toEqual({ logarithmic: true, low: 0.01, high: 1000 });
    expect(placeOn(axis, 0.01)).toBe(0);
    expect(placeOn(axis, 10)).toBeCloseTo(0.6, 12);
    expect(placeOn(axis, 0)).toBe(0);
    const numbers = (room: number) =>
      axisTicks(axis, room).map((tick) => Number(tick.toPrecision(3)));
    expect(numbers(9)).toEqual([0.01, 0.1, 1, 10, 100, 1000]);
    expect(numbers(3.3)).toEqual([0.01, 1, 100]);
    expect(numbers(0)).toEqual([0.01, 1000]);
    expect(histogram(axis, [0.02, 0.03, 300], 5)).toEqual([2, 0, 0, 0, 1]);
  });

  it('exists without errors', () => {
    expect(errorAxis([])).toEqual({ logarithmic: false, low: 0, high: 1 });
    expect(errorAxis([0])).toEqual({ logarithmic: false, low: 0, high: 1 });
  });
});
