import { afterEach, beforeEach, expect, it, vi } from 'vitest';
import { followSize } from '../../../src/views/scene/scene_size';

let resize: (width: number, height: number) => void;
const sizes: [number, number][] = [];

beforeEach(() => {
  vi.useFakeTimers();
  sizes.length = 0;
  vi.stubGlobal('window', { devicePixelRatio: 2, setTimeout, clearTimeout });
  vi.stubGlobal('requestAnimationFrame', (frame: () => void) => frame());
  type Seen = (entries: { contentRect: { width: number; height: number } }[]) => void;
  vi.stubGlobal(
    'ResizeObserver',
    class {
      constructor(seen: Seen) {
        resize = (width, height) => {
          seen([{ contentRect: { width, height } }]);
          vi.advanceTimersByTime(1000);
        };
      }
      observe(): void {
        // The test says what happens.
      }
    },
  );
  followSize({} as HTMLElement, (width_px, height_px) => sizes.push([width_px, height_px]));
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

it('pictures have the size of the panel in even pixels, within the limits', () => {
  resize(300.4, 200);
  resize(2000, 10);
  expect(sizes).toEqual([
    [600, 400],
    [1920, 64],
  ]);
});

it('a panel that is hidden and shown again keeps its size', () => {
  resize(300, 200);
  resize(0, 0);
  resize(300, 200);
  expect(sizes).toEqual([[600, 400]]);
});
