import { describe, expect, it } from 'vitest';
import { lastAtOrBefore, nearestIndex, Table } from '../../src/store/table';

describe('Table', () => {
  it('keeps rows across growth and reads null as NaN', () => {
    const table = new Table();
    for (let row = 0; row < 5000; row += 500) {
      const a = Array.from({ length: 500 }, (_, i) => row + i);
      table.write(row, 500, { a, b: a.map(() => null) });
    }
    expect(table.length).toBe(5000);
    expect(table.at('a', 4999)).toBe(4999);
    expect(table.at('a', 0)).toBe(0);
    expect(table.at('b', 17)).toBeNaN();
    expect(table.at('a', 5000)).toBeNaN();
  });

  it('forgets what stood behind rows written again', () => {
    const table = new Table();
    table.write(0, 3, { a: [1, 2, 3] });
    table.write(1, 1, { a: [9] });
    expect([...table.column('a')]).toEqual([1, 9]);
  });
});

describe('columns', () => {
  it('may begin later, and be absent', () => {
    const table = new Table();
    table.write(0, 2, { a: [1, 2], text: ['x', 'y'] });
    table.write(2, 1, { a: [3], late: [7] });
    expect([...table.column('late')]).toEqual([NaN, NaN, 7]);
    expect([...table.column('never')]).toEqual([NaN, NaN, NaN]);
    expect(['a', 'late', 'text', 'never'].map((name) => table.has(name))).toEqual([
      true,
      true,
      false,
      false,
    ]);
    table.write(3, 1, { a: [4] });
    expect([...table.column('late')]).toEqual([NaN, NaN, 7, NaN]);
    expect(table.last('a')).toBe(4);
  });
});

describe('searching', () => {
  const times = [10, 20, 30];

  it.each([
    [9, -1],
    [10, 0],
    [19.9, 0],
    [30, 2],
    [99, 2],
  ])('finds the last at or before %d', (x, index) => {
    expect(lastAtOrBefore(times, x)).toBe(index);
  });

  it.each([
    [-5, 0],
    [14, 0],
    [16, 1],
    [99, 2],
  ])('finds the nearest to %d', (x, index) => {
    expect(nearestIndex(times, x)).toBe(index);
  });

  it('finds nothing in nothing', () => {
    expect(nearestIndex([], 1)).toBe(-1);
  });
});
