import { describe, expect, it } from 'vitest';
import type { Box3 } from '../../../src/store/plot3d/axis_box';
import type { OrbitView } from '../../../src/store/plot3d/orbit_view';
import {
  fittedTo,
  panned,
  rotated,
  screenAxes,
  screenMap,
  toScreen,
  zoomedAbout,
} from '../../../src/store/plot3d/orbit_view';

const size = { width_px: 800, height_px: 600 };
const oblique: OrbitView = {
  target: [10, 20, 30],
  azimuth_rad: 0.7,
  elevation_rad: 0.4,
  m_per_px: 2,
};
const box: Box3 = { min: [-300, -100, 200], max: [500, 900, 350] };

function close(actual: readonly number[], expected: readonly number[]): void {
  expect(actual).toHaveLength(expected.length);
  actual.forEach((value, i) => expect(value).toBeCloseTo(expected[i] ?? NaN, 6));
}

describe('the viewpoint of the 3D plot', () => {
  it('has east to the right and north up from above', () => {
    const top = { ...oblique, azimuth_rad: 0, elevation_rad: Math.PI / 2 };
    const map = screenMap(top, size, 1);
    close(toScreen(map, [10, 20, 999]), [400, 300]);
    close(toScreen(map, [110, 20, 0]), [450, 300]);
    close(toScreen(map, [10, 120, 0]), [400, 250]);
  });

  it('has east to the right and up upwards from the south', () => {
    const side = { ...oblique, azimuth_rad: 0, elevation_rad: 0 };
    const map = screenMap(side, size, 1);
    close(toScreen(map, [110, 777, 30]), [450, 300]);
    close(toScreen(map, [10, 0, 130]), [400, 250]);
  });

  it('sees north on the left when it looks east', () => {
    const map = screenMap({ ...oblique, azimuth_rad: Math.PI / 2, elevation_rad: 0 }, size, 1);
    close(toScreen(map, [0, 120, 30]), [350, 300]);
  });

  it('has axes at right angles', () => {
    const { right, up, ahead } = screenAxes(oblique);
    const dot = (a: readonly number[], b: readonly number[]) =>
      a.reduce((sum, part, i) => sum + part * (b[i] ?? NaN), 0);
    close(
      [dot(right, right), dot(up, up), dot(ahead, ahead), dot(right, up), dot(up, ahead)],
      [1, 1, 1, 0, 0],
    );
  });

  it('exaggerates heights', () => {
    const side = { ...oblique, azimuth_rad: 0, elevation_rad: 0, target: [0, 0, 0] as const };
    close(toScreen(screenMap(side, size, 5), [0, 0, 20]), [400, 250]);
  });

  it.each([1, 10])('shows a whole box, heights times %d', (heightScale) => {
    for (let azimuth_rad = -3; azimuth_rad < 3; azimuth_rad += 0.5) {
      const fit = fittedTo({ ...oblique, azimuth_rad }, box, size, heightScale);
      const map = screenMap(fit, size, heightScale);
      for (const x of [box.min[0], box.max[0]]) {
        for (const y of [box.min[1], box.max[1]]) {
          for (const z of [box.min[2], box.max[2]]) {
            const [px, py] = toScreen(map, [x, y, z]);
            expect(Math.abs(px - 400)).toBeLessThanOrEqual(400 - 45);
            expect(Math.abs(py - 300)).toBeLessThanOrEqual(300 - 45);
          }
        }
      }
    }
  });

  it('moves what is under the mouse along with it', () => {
    const place = [100, -50, 80] as const;
    const [x, y] = toScreen(screenMap(oblique, size, 1), place);
    close(toScreen(screenMap(panned(oblique, 30, -12), size, 1), place), [x + 30, y - 12]);
  });

  it('zooms about the mouse, within limits', () => {
    const place = [100, -50, 80] as const;
    const at = toScreen(screenMap(oblique, size, 1), place);
    // The fixed pixel is that of a whole line of sight, on which the place lies.
    const near = zoomedAbout(oblique, size, at, 0.25);
    expect(near.m_per_px).toBe(0.5);
    close(toScreen(screenMap(near, size, 1), place), at);
    expect(zoomedAbout(oblique, size, at, 1e-30).m_per_px).toBe(1e-4);
    expect(zoomedAbout(oblique, size, at, 1e30).m_per_px).toBe(1e5);
  });

  it('turns around its target, never below the ground', () => {
    const turned = rotated(oblique, 100, 20);
    expect(turned.azimuth_rad).toBeGreaterThan(oblique.azimuth_rad);
    expect(turned.elevation_rad).toBeGreaterThan(oblique.elevation_rad);
    close(toScreen(screenMap(turned, size, 1), oblique.target), [400, 300]);
    expect(rotated(oblique, 0, -1e6).elevation_rad).toBe(0);
    expect(rotated(oblique, 0, 1e6).elevation_rad).toBe(Math.PI / 2);
  });
});
