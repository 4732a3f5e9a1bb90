import { describe, expect, it } from 'vitest';
import type { Box3 } from '../../../src/store/plot3d/axis_box';
import { axisScales, boxOfAll, boxOfScales } from '../../../src/store/plot3d/axis_box';

describe('the axes of the 3D plot', () => {
  it('have round numbers around the tracks, and one step across', () => {
    const [x, y, z] = axisScales({ min: [-62, -640, 100], max: [75, 597, 290] }, 1);
    expect([x.step, y.step]).toEqual([100, 100]);
    expect([x.low, x.high, y.low, y.high]).toEqual([-100, 100, -700, 600]);
    expect(x.ticks).toEqual([-100, 0, 100]);
    expect([z.low, z.high, z.step]).toEqual([100, 300, 50]);
  });

  it('have few heights of a flat flight, more where heights are exaggerated', () => {
    const flat = { min: [0, 0, 299] as const, max: [1000, 1000, 301] as const };
    const box = { min: [...flat.min], max: [...flat.max] } as Parameters<typeof axisScales>[0];
    expect(axisScales(box, 1)[2]).toMatchObject({ low: 250, high: 350, step: 50 });
    expect(axisScales(box, 20)[2]).toMatchObject({ low: 298, high: 302, step: 2 });
  });

  it('have a size where an aircraft stands, on a tick or between two', () => {
    for (const at of [0, 0.3, -1234.5]) {
      const scales = axisScales({ min: [at, at, at], max: [at, at, at] }, 1);
      for (const { low, high, ticks } of scales) {
        expect(low).toBeLessThanOrEqual(at + 1e-9);
        expect(high).toBeGreaterThanOrEqual(at - 1e-9);
        expect(high).toBeGreaterThan(low);
        expect(ticks.length).toBeGreaterThanOrEqual(2);
      }
    }
  });

  it('never have many ticks', () => {
    for (let size_m = 0.01; size_m < 2e7; size_m *= 1.7) {
      const scales = axisScales({ min: [-size_m, 0, 0], max: [size_m, 3, size_m] }, 1);
      for (const { ticks } of scales) expect(ticks.length).toBeLessThanOrEqual(17);
    }
  });

  it('enclose all tracks but those that have diverged', () => {
    const truth: Box3 = { min: [0, 0, 0], max: [1, 1, 1] };
    const near: Box3 = { min: [-5, 0.5, 0], max: [0, 9, 0] };
    const far: Box3 = { min: [0, 0, -4e12], max: [1, 1, 0] };
    const tracks = [
      { box: truth, estimate: false },
      { box: far, estimate: true },
      { box: null, estimate: true },
      { box: near, estimate: true },
    ];
    expect(boxOfAll(tracks)).toEqual({ box: { min: [-5, 0, 0], max: [1, 9, 1] }, beyond: [1] });
    expect(boxOfAll(tracks.slice(1, 3))).toEqual({ box: far, beyond: [] });
    expect(boxOfAll([{ box: null, estimate: true }])).toBeNull();
    const box = { min: [0, 0, 0], max: [100, 100, 50] } as Parameters<typeof axisScales>[0];
    expect(boxOfScales(axisScales(box, 1))).toEqual(box);
  });
});
