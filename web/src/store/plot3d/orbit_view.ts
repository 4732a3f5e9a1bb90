// The viewpoint of the 3D plot: a parallel projection, so that equal lengths stay equal everywhere
// and places can be read off the axes. Heights are exaggerated before they are projected.
import type { Size } from '../plots/path_frame';
import type { Box3, Point3 } from './axis_box';

export interface OrbitView {
  /** In the middle of the plot, its height exaggerated [m, east-north-up]. */
  target: Point3;
  /** Of the direction of view, clockwise from north. */
  azimuth_rad: number;
  /** Of the eye above the horizon, 0 to pi / 2. */
  elevation_rad: number;
  m_per_px: number;
}

/** Pixels of a place (x, y, z), z not exaggerated: p[0] x + p[1] y + p[2] z + p[3]. */
export interface ScreenMap {
  x_px: readonly [number, number, number, number];
  /** Downwards. */
  y_px: readonly [number, number, number, number];
}

const kTurn_rad_px = 0.006;
const kScaleRange_m = [1e-4, 1e5] as const;
/** For the numbers of the axes, and for what lies over the plot's upper edge. */
const kMargin_px = { across: 46, up: 60 } as const;

/** Of the screen, in east-north-up; `ahead` is the direction of view. */
export function screenAxes({ azimuth_rad, elevation_rad }: OrbitView) {
  const [sa, ca] = [Math.sin(azimuth_rad), Math.cos(azimuth_rad)];
  const [se, ce] = [Math.sin(elevation_rad), Math.cos(elevation_rad)];
  return {
    right: [ca, -sa, 0] as Point3,
    up: [sa * se, ca * se, ce] as Point3,
    ahead: [sa * ce, ca * ce, -se] as Point3,
  };
}

export function screenMap(
  view: OrbitView,
  { width_px, height_px }: Size,
  heightScale: number,
): ScreenMap {
  const { right, up } = screenAxes(view);
  const { target, m_per_px } = view;
  const row = (axis: Point3, sign: 1 | -1, middle_px: number) => {
    const [x, y, z] = axis.map((part) => (sign * part) / m_per_px) as [number, number, number];
    const offset = middle_px - x * target[0] - y * target[1] - z * target[2];
    return [x, y, z * heightScale, offset] as const;
  };
  return { x_px: row(right, 1, width_px / 2), y_px: row(up, -1, height_px / 2) };
}

export function toScreen({ x_px, y_px }: ScreenMap, [x, y, z]: Point3): [number, number] {
  return [
    x_px[0] * x + x_px[1] * y + x_px[2] * z + x_px[3],
    y_px[0] * x + y_px[1] * y + y_px[2] * z + y_px[3],
  ];
}

/** Turned by a movement of the mouse. */
export function rotated(view: OrbitView, dx_px: number, dy_px: number): OrbitView {
  const elevation_rad = view.elevation_rad + dy_px * kTurn_rad_px;
  return {
    ...view,
    azimuth_rad: view.azimuth_rad + dx_px * kTurn_rad_px,
    elevation_rad: Math.min(Math.PI / 2, Math.max(0, elevation_rad)),
  };
}

/** Moved so that what was at a pixel follows the mouse. */
export function panned(view: OrbitView, dx_px: number, dy_px: number): OrbitView {
  const { right, up } = screenAxes(view);
  const [across_m, up_m] = [-dx_px * view.m_per_px, dy_px * view.m_per_px];
  return { ...view, target: moved(view.target, right, across_m, up, up_m) };
}

/** Zooms about a fixed pixel; a factor below 1 shows less. */
export function zoomedAbout(
  view: OrbitView,
  { width_px, height_px }: Size,
  [x_px, y_px]: readonly [number, number],
  factor: number,
): OrbitView {
  const [low, high] = kScaleRange_m;
  const m_per_px = Math.min(high, Math.max(low, view.m_per_px * factor));
  const { right, up } = screenAxes(view);
  const change_m = view.m_per_px - m_per_px;
  const across_m = (x_px - width_px / 2) * change_m;
  const up_m = (height_px / 2 - y_px) * change_m;
  return { ...view, m_per_px, target: moved(view.target, right, across_m, up, up_m) };
}

/** Shows all of a box from the direction of `view`. */
export function fittedTo(
  view: OrbitView,
  { min, max }: Box3,
  { width_px, height_px }: Size,
  heightScale: number,
): OrbitView {
  const { right, up } = screenAxes(view);
  const size = [max[0] - min[0], max[1] - min[1], (max[2] - min[2]) * heightScale];
  const extent_m = (axis: Point3) =>
    axis.reduce((sum, part, i) => sum + Math.abs(part) * (size[i] ?? 0), 0);
  const [low, high] = kScaleRange_m;
  const fitting = Math.max(
    extent_m(right) / Math.max(1, width_px - 2 * kMargin_px.across),
    extent_m(up) / Math.max(1, height_px - 2 * kMargin_px.up),
  );
  return {
    ...view,
    target: [(min[0] + max[0]) / 2, (min[1] + max[1]) / 2, ((min[2] + max[2]) / 2) * heightScale],
    m_per_px: Math.min(high, Math.max(low, fitting)),
  };
}

function moved(from: Point3, right: Point3, across_m: number, up: Point3, up_m: number): Point3 {
  return [
    from[0] + right[0] * across_m + up[0] * up_m,
    from[1] + right[1] * across_m + up[1] * up_m,
    from[2] + right[2] * across_m + up[2] * up_m,
  ];
}
