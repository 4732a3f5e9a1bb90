import { describe, expect, it } from 'vitest';
import { curveTable, valueAt } from '../../../src/store/sensors/sensor_curves';

const every = (step_s: number, count: number, begin_s = 0) =>
  Array.from({ length: count }, (_, i) => begin_s + i * step_s);

describe('curveTable', () => {
  it('puts curves of different times on one axis without breaking them', () => {
    const { t_s, curves } = curveTable(
      [
        { name: 'x', t_s: [0, 2, 4], values: [10, 20, 30] },
        { name: 'y', t_s: [0, 3, 4], values: [1, 2, 3] },
      ],
      10,
    );
    expect([...t_s]).toEqual([0, 2, 3, 4]);
    expect(curves).toEqual([
      [1, 2, undefined, 3],
      [0.1, undefined, 0.2, 0.3],
    ]);
  });

  it('breaks a curve where values are missing for long', () => {
    const times = [...every(0.2, 50), ...every(0.2, 50, 30)];
    const { t_s, curves } = curveTable([{ name: 'x', t_s: times, values: times }], 1);
    const gap = curves[0]?.indexOf(null) ?? -1;
    expect(gap).toBe(50);
    expect(t_s[gap]).toBeCloseTo(19.9);
    expect(curves[0]?.filter((value) => value === null)).toHaveLength(1);
  });

  it('is empty for a sensor without values', () => {
    const { t_s, curves } = curveTable([{ name: 'x', t_s: [], values: [] }], 1);
    expect(t_s).toHaveLength(0);
    expect(curves).toEqual([[]]);
  });
});

describe('valueAt', () => {
  const t_s = [...every(1, 10), ...every(1, 10, 100)];
  const curve = { name: 'x', t_s, values: t_s.map((t) => 2 * t) };

  it('is the latest one', () => {
    expect(valueAt(curve, 3.7)).toBe(6);
    expect(valueAt(curve, 105)).toBe(210);
    expect(valueAt(curve, -1)).toBeNull();
  });

  it('is none in a gap', () => {
    expect(valueAt(curve, 50)).toBeNull();
    expect(valueAt(curve, 1000)).toBeNull();
  });
});
