import { describe, expect, it } from 'vitest';
import {
  kWholePicture,
  panned,
  pixelAt,
  placed,
  shareAt,
  widthWanted,
  zoomedAt,
} from '../../../src/store/pictures/picture_zoom';

const kArea = { width: 400, height: 400 };
const kPicture = { width: 1280, height: 960 };

describe('the zoom of a picture', () => {
  it('shows the whole picture in the middle at first', () => {
    expect(placed(kArea, kPicture, kWholePicture)).toEqual({
      x: 0,
      y: 50,
      width: 400,
      height: 300,
    });
  });

  it('keeps the place under the mouse while it zooms', () => {
    const point = { x: 130, y: 220 };
    let zoom = zoomedAt(kArea, kPicture, kWholePicture, { x: 200, y: 200 }, 2);
    const before = shareAt(placed(kArea, kPicture, zoom), point);
    for (let i = 0; i < 12; i++) zoom = zoomedAt(kArea, kPicture, zoom, point, 1.2);
    expect(zoom.scale).toBeCloseTo(2 * 1.2 ** 12);
    const after = shareAt(placed(kArea, kPicture, zoom), point);
    expect(after.x).toBeCloseTo(before.x, 9);
    expect(after.y).toBeCloseTo(before.y, 9);
  });

  it('shows the whole picture again when it is zoomed out, and never less', () => {
    const zoom = zoomedAt(kArea, kPicture, kWholePicture, { x: 10, y: 60 }, 8);
    expect(zoomedAt(kArea, kPicture, zoom, { x: 390, y: 300 }, 0.01)).toEqual(kWholePicture);
  });

  it('moves with the mouse, but not out of the area', () => {
    const zoom = zoomedAt(kArea, kPicture, kWholePicture, { x: 200, y: 200 }, 4);
    const before = placed(kArea, kPicture, zoom);
    const moved = placed(kArea, kPicture, panned(kArea, kPicture, zoom, { x: 30, y: -20 }));
    expect(moved.x - before.x).toBeCloseTo(30, 9);
    expect(moved.y - before.y).toBeCloseTo(-20, 9);
    const far = placed(kArea, kPicture, panned(kArea, kPicture, zoom, { x: 9e9, y: -9e9 }));
    expect(far.x).toBeCloseTo(0, 6);
    expect(far.y + far.height).toBeCloseTo(400, 6);
  });

  it('keeps a picture centred that is lower than the area', () => {
    const zoom = zoomedAt(kArea, kPicture, kWholePicture, { x: 0, y: 50 }, 1.2);
    expect(placed(kArea, kPicture, zoom).y).toBeCloseTo((400 - 360) / 2, 9);
  });

  it('tells the pixel of the whole image; centres are at integers', () => {
    expect(pixelAt({ x: 0, y: 0 }, kPicture)).toEqual({ x: -0.5, y: -0.5 });
    expect(pixelAt({ x: 0.5, y: 0.5 }, kPicture)).toEqual({ x: 639.5, y: 479.5 });
    expect(pixelAt({ x: 1, y: 0.5 }, kPicture)).toBeNull();
    expect(pixelAt({ x: 0.5, y: -0.001 }, kPicture)).toBeNull();
  });

  it('wants as many pixels as the screen shows', () => {
    expect(widthWanted({ width: 300, height: 200 }, kWholePicture, 1)).toBe(320);
    expect(widthWanted({ width: 300, height: 200 }, kWholePicture, 2)).toBe(640);
    expect(widthWanted({ width: 300, height: 200 }, { scale: 4, x: 0.5, y: 0.5 }, 1)).toBe(1280);
    expect(widthWanted({ width: 900, height: 200 }, { scale: 9, x: 0.5, y: 0.5 }, 1)).toBe(8192);
  });
});
