import { describe, expect, it } from 'vitest';
import { placeLabels } from '../../../src/store/scene/scene_labels';

const kArea = { width: 400, height: 300 };
const label = (x: number, y: number) => ({ x, y, width: 60, height: 16 });

describe('the labels of a scene', () => {
  it('stand above their places', () => {
    const [place] = placeLabels([label(200, 150)], kArea);
    expect(place?.left).toBe(170);
    expect((place?.top ?? 0) + 16).toBeLessThan(150);
  });

  it('do not cover each other where truth and estimates coincide', () => {
    const places = placeLabels([label(200, 150), label(201, 150), label(205, 152)], kArea);
    const tops = places.map(({ top }) => top).sort((a, b) => a - b);
    for (let i = 1; i < tops.length; i++) {
      expect((tops[i] ?? 0) - (tops[i - 1] ?? 0)).toBeGreaterThanOrEqual(16);
    }
  });

  it('stay inside the picture', () => {
    const boxes = [label(1, 2), label(399, 299), label(2, 3), label(3, 3)];
    for (const { left, top } of placeLabels(boxes, kArea)) {
      expect(left).toBeGreaterThanOrEqual(0);
      expect(left + 60).toBeLessThanOrEqual(400);
      expect(top).toBeGreaterThanOrEqual(0);
      expect(top + 16).toBeLessThanOrEqual(300);
    }
  });
});
