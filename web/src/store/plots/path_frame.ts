// The part of the ground plane or of a vertical plane that a path plot shows: equal scales on both
// axes, so that a circle is a circle.
import type { CurveHue } from './plot_specs';
import type { Extent, SharedExtent } from './shared_extent';
import { sharedExtent } from './shared_extent';

/** A track as it is drawn. */
export interface Path {
  name: string;
  hue: CurveHue;
  x: ArrayLike<number>;
  y: ArrayLike<number>;
  t: ArrayLike<number>;
  /** Seconds of the clock = t * t_scale_s + t_offset_s. */
  t_scale_s: number;
  t_offset_s: number;
}

/** Where a track is at the clock's time. */
export interface PathMark {
  hue: CurveHue;
  x: number;
  y: number;
}

export interface Size {
  width_px: number;
  height_px: number;
}

/** Maps metres to pixels: x to the right, y up. */
export interface PathFrame {
  /** In the middle of the plot [m]. */
  centre_m: [number, number];
  m_per_px: number;
}

const kMargin = 1.12;
const kLeast_m = 2;
const kLeastStepWithExponent = 1e4;
/** More than a double has are refused by toExponential. */
const kMostExponentDigits = 16;
const kScaleRange_m = [1e-4, 1e5] as const;

/** Shows all from the least to the greatest x and y; the origin if there is nothing. */
export function fitted(
  box: Pick<SharedExtent, 'low' | 'high'> | null,
  { width_px, height_px }: Size,
): PathFrame {
  const [left = 0, bottom = 0] = box?.low ?? [];
  const [right = 0, top = 0] = box?.high ?? [];
  const width_m = Math.max(kLeast_m, right - left) * kMargin;
  const height_m = Math.max(kLeast_m, top - bottom) * kMargin;
  return {
    centre_m: [(left + right) / 2, (bottom + top) / 2],
    m_per_px: Math.max(width_m / Math.max(1, width_px), height_m / Math.max(1, height_px)),
  };
}

export function toPixels(
  { centre_m, m_per_px }: PathFrame,
  { width_px, height_px }: Size,
  [x_m, y_m]: readonly [number, number],
): [number, number] {
  return [
    width_px / 2 + (x_m - centre_m[0]) / m_per_px,
    height_px / 2 - (y_m - centre_m[1]) / m_per_px,
  ];
}

export function toMetres(
  { centre_m, m_per_px }: PathFrame,
  { width_px, height_px }: Size,
  [x_px, y_px]: readonly [number, number],
): [number, number] {
  return [
    centre_m[0] + (x_px - width_px / 2) * m_per_px,
    centre_m[1] - (y_px - height_px / 2) * m_per_px,
  ];
}

/** Zooms about a fixed point; a factor below 1 shows less. */
export function zoomedAt(
  frame: PathFrame,
  size: Size,
  at_px: readonly [number, number],
  factor: number,
): PathFrame {
  const fixed_m = toMetres(frame, size, at_px);
  const [low, high] = kScaleRange_m;
  const m_per_px = Math.min(high, Math.max(low, frame.m_per_px * factor));
  const ratio = m_per_px / frame.m_per_px;
  return {
    centre_m: [
      fixed_m[0] + (frame.centre_m[0] - fixed_m[0]) * ratio,
      fixed_m[1] + (frame.centre_m[1] - fixed_m[1]) * ratio,
    ],
    m_per_px,
  };
}

/** The least of 1, 2 or 5 times a power of ten that is not below `least`, except by rounding. */
export function niceStep(least: number): number {
  const power = 10 ** Math.floor(Math.log10(least));
  return ([1, 2, 5, 10].find((factor) => factor * power >= least * 0.999) ?? 10) * power;
}

/** Positions of an axis's numbers: multiples of 1, 2 or 5 times a power of ten. */
export function ticks(low: number, high: number, most: number): number[] {
  const span = high - low;
  if (!(span > 0) || most < 1) return [];
  const step = niceStep(span / most);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) => (first + i) * step);
}

/** A tick's number with the digits of its step; with an exponent where they are many: "1.5e12". */
export function tickText(value: number, step: number): string {
  const power = Math.floor(Math.log10(step) + 1e-9);
  const mantissa = step / 10 ** power;
  /** Of the step's last digit: a step may be 2.5 times a power of ten. */
  const last = Math.abs(mantissa - Math.round(mantissa)) < 1e-6 ? power : power - 1;
  if (step >= kLeastStepWithExponent && value !== 0) {
    const first = Math.floor(Math.log10(Math.abs(value)) + 1e-9);
    const digits = Math.min(kMostExponentDigits, Math.max(0, first - last));
    return value.toExponential(digits).replace('e+', 'e').replace('-', '−');
  }
  const text = value.toFixed(Math.min(6, Math.max(0, -last)));
  return Number(text) === 0 ? text.replace('-', '') : text.replace('-', '−');
}

/** Encloses all tracks but those that have diverged; null without any point. */
export function boxOf(paths: readonly Pick<Path, 'hue' | 'x' | 'y'>[]): SharedExtent | null {
  return sharedExtent(paths.map(extentOf), kLeast_m);
}

/** Of all finite points. */
function extentOf({ hue, x, y }: Pick<Path, 'hue' | 'x' | 'y'>): Extent | null {
  const low: [number, number] = [Infinity, Infinity];
  const high: [number, number] = [-Infinity, -Infinity];
  for (let i = 0; i < x.length; i += 1) {
    const px = x[i] ?? NaN;
    const py = y[i] ?? NaN;
    if (!Number.isFinite(px) || !Number.isFinite(py)) continue;
    low[0] = Math.min(low[0], px);
    low[1] = Math.min(low[1], py);
    high[0] = Math.max(high[0], px);
    high[1] = Math.max(high[1], py);
  }
  return low[0] > high[0] ? null : { low, high, estimate: hue.kind === 'estimate' };
}
