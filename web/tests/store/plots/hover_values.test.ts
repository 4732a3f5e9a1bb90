import { describe, expect, it } from 'vitest';
import { hoverRows } from '../../../src/store/plots/hover_values';

describe('hoverRows', () => {
  it('lists the curves as they lie above each other, and marks the nearest one', () => {
    const { rows, nearest, more } = hoverRows([1, 5, NaN, null, 3], 3.4, 10);
    expect(rows.map(({ index }) => index)).toEqual([1, 4, 0]);
    expect(rows.map(({ value }) => value)).toEqual([5, 3, 1]);
    expect(nearest).toBe(4);
    expect(more).toBe(0);
  });

  it('keeps those that are nearest to the mouse if there are too many', () => {
    const values = Array.from({ length: 64 }, (_, i) => i);
    const { rows, nearest, more } = hoverRows(values, 40.2, 5);
    expect(rows.map(({ index }) => index)).toEqual([42, 41, 40, 39, 38]);
    expect(nearest).toBe(40);
    expect(more).toBe(59);
  });

  it('keeps the order of equal values, and is empty without values', () => {
    expect(hoverRows([2, 2], 2, 9).rows.map(({ index }) => index)).toEqual([0, 1]);
    expect(hoverRows([null, NaN], 2, 9)).toEqual({ rows: [], nearest: -1, more: 0 });
  });
});
