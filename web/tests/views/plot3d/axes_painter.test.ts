import { expect, it, vi } from 'vitest';
import type { Box3 } from '../../../src/store/plot3d/axis_box';
import { axisScales } from '../../../src/store/plot3d/axis_box';
import { screenMap } from '../../../src/store/plot3d/orbit_view';
import type { Pen } from '../../../src/store/plots/svg_pen';
import { paintAxes } from '../../../src/views/plot3d/axes_painter';

vi.mock('../../../src/views/paint', () => ({ paint: (colour: string) => colour }));

const kLetter_px = 6;
const kHeight_px = 12;

interface Text {
  text: string;
  left: number;
  top: number;
}

function texts(box: Box3, azimuth_rad: number, m_per_px: number): Text[] {
  const painted: Text[] = [];
  const none = () => undefined;
  const pen = {
    textAlign: 'left' as CanvasTextAlign,
    textBaseline: 'top' as CanvasTextBaseline,
    beginPath: none,
    moveTo: none,
    lineTo: none,
    stroke: none,
    measureText: (text: string) => ({ width: kLetter_px * text.length }),
    fillText(text: string, x: number, y: number) {
      const across = { left: 0, center: 0.5, right: 1 }[this.textAlign as 'left'];
      const up = { top: 0, middle: 0.5, bottom: 1 }[this.textBaseline as 'top'];
      const left = x - across * kLetter_px * text.length;
      painted.push({ text, left, top: y - up * kHeight_px });
    },
  };
  const target = [0, 1, 2].map((i) => ((box.min[i] ?? 0) + (box.max[i] ?? 0)) / 2);
  const [x = 0, y = 0, z = 0] = target;
  const view = { target: [x, y, z] as const, azimuth_rad, elevation_rad: 0.5, m_per_px };
  const map = screenMap(view, { width_px: 400, height_px: 250 }, 1);
  paintAxes(pen as unknown as Pen, axisScales(box, 1), view, map);
  return painted;
}

it('a short edge has its name and the numbers of its ends', () => {
  // A flight to the north; the west-east edge is 20 px long.
  const shown = texts({ min: [-40, 0, 0], max: [40, 600, 200] }, 0.1, 4).map(({ text }) => text);
  expect(shown).toContain('x east [m]');
  expect(shown.slice(0, shown.indexOf('x east [m]'))).toEqual(['\u221250', '50']);
});

it('an edge that is seen from its end has no name', () => {
  expect(texts({ min: [0, 0, 0], max: [100, 600, 200] }, 1, 1e3)).toEqual([]);
});

it('no name or number lies on another one', () => {
  for (let azimuth_rad = 0; azimuth_rad < 6.28; azimuth_rad += 0.1) {
    for (const m_per_px of [2, 3, 6]) {
      const shown = texts({ min: [-100, 0, 0], max: [300, 600, 200] }, azimuth_rad, m_per_px);
      shown.forEach((one, i) => {
        for (const other of shown.slice(0, i)) {
          const apart =
            one.left >= other.left + kLetter_px * other.text.length ||
            other.left >= one.left + kLetter_px * one.text.length ||
            Math.abs(one.top - other.top) >= kHeight_px;
          expect(apart, `${one.text} on ${other.text} from ${azimuth_rad}`).toBe(true);
        }
      });
    }
  }
});
