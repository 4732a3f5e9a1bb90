// The size in which the server draws the 3D view.
import { perFrame } from '../dom';

const kResizeWait_ms = 150;
const kWidthRange_px = [64, 1920] as const;
const kHeightRange_px = [64, 1440] as const;

/** Requests pictures of an area's size once the size is stable. */
export function followSize(
  area: HTMLElement,
  setSize: (width_px: number, height_px: number) => void,
): void {
  let timer = 0;
  let asked = '';
  const ask = perFrame((size: { width: number; height: number }) => {
    const width_px = even(size.width * window.devicePixelRatio, kWidthRange_px);
    const height_px = even(size.height * window.devicePixelRatio, kHeightRange_px);
    const key = `${width_px}x${height_px}`;
    if (key === asked) return;
    asked = key;
    setSize(width_px, height_px);
  });
  new ResizeObserver(([entry]) => {
    if (entry === undefined) return;
    const { width, height } = entry.contentRect;
    window.clearTimeout(timer);
    // Behind another panel it has no size, and is shown again in the one that it had.
    if (width === 0 || height === 0) return;
    timer = window.setTimeout(() => ask({ width, height }), asked === '' ? 0 : kResizeWait_ms);
  }).observe(area);
}

function even(value: number, [low, high]: readonly [number, number]): number {
  return Math.min(high, Math.max(low, Math.round(value / 2) * 2));
}
