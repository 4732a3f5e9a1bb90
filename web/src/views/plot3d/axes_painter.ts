// Paints the box around the tracks: a grid on its floor and on the walls behind them, and numbers
// along the edges in front.
import type { AxisScale, AxisScales, Point3 } from '../../store/plot3d/axis_box';
import type { OrbitView, ScreenMap } from '../../store/plot3d/orbit_view';
import { toScreen } from '../../store/plot3d/orbit_view';
import type { Pen } from '../../store/plots/svg_pen';
import { tickText } from '../../store/plots/path_frame';
import { paint } from '../paint';

const kFont = '10px system-ui, sans-serif';
const kTitles = ['x east [m]', 'y north [m]', 'z up [m]'] as const;
const kGap_px = 7;
const kLine_px = 13;
const kApart_px = 2;
/** A name stands beyond the numbers, not between them. */
const kNameApart_px = 12;
/** From this part of a direction on it is more across than up. */
const kSlant = 0.5;
/** A shorter edge is seen from its end: nothing can be read off it. */
const kLeastEdge_px = 4;
/** A shorter edge has the numbers of its ends only. */
const kShortEdge_px = 40;
/** Names are moved away from what they would cover. */
const kStep_px = 4;
const kMostSteps = 20;
/** The middle of a text, from where it is placed. */
const kMiddle_px: Readonly<Partial<Record<CanvasTextBaseline, number>>> = {
  top: kLine_px / 2,
  bottom: -kLine_px / 2,
};

type Pixel = [number, number];
type Axis = 0 | 1 | 2;

/** The edges of the box with numbers, and the walls behind the tracks. */
interface Sides {
  nearX: number;
  nearY: number;
  farX: number;
  farY: number;
}

export function paintAxes(pen: Pen, scales: AxisScales, view: OrbitView, map: ScreenMap): void {
  const sides = sidesOf(scales, view);
  pen.lineWidth = 1;
  pen.font = kFont;
  paintGrid(pen, scales, sides, map);
  const painted = new Texts(pen);
  const [x, y, z] = scales;
  const centre: Point3 = [(x.low + x.high) / 2, (y.low + y.high) / 2, z.low];
  const middle = toScreen(map, centre);
  paintEdge(painted, 0, x, (value) => toScreen(map, [value, sides.nearY, z.low]), middle);
  paintEdge(painted, 1, y, (value) => toScreen(map, [sides.nearX, value, z.low]), middle);
  const corners: [number, number][] = [
    [sides.nearX, sides.farY],
    [sides.farX, sides.nearY],
  ];
  const left = corners.sort((a, b) => screenX(map, a, z.low) - screenX(map, b, z.low))[0];
  if (left === undefined) return;
  const foot = toScreen(map, [...left, z.low]);
  paintEdge(painted, 2, z, (value) => toScreen(map, [...left, value]), [foot[0] + 1, foot[1]]);
}

function sidesOf([x, y]: AxisScales, { azimuth_rad }: OrbitView): Sides {
  const fromWest = Math.sin(azimuth_rad) > -1e-6;
  const fromSouth = Math.cos(azimuth_rad) > -1e-6;
  return {
    nearX: fromWest ? x.low : x.high,
    farX: fromWest ? x.high : x.low,
    nearY: fromSouth ? y.low : y.high,
    farY: fromSouth ? y.high : y.low,
  };
}

function screenX(map: ScreenMap, [x, y]: readonly [number, number], z: number): number {
  return toScreen(map, [x, y, z])[0];
}

function paintGrid(pen: Pen, [x, y, z]: AxisScales, { farX, farY }: Sides, map: ScreenMap): void {
  pen.strokeStyle = paint('var(--grid)');
  pen.beginPath();
  const line = (from: Point3, to: Point3) => {
    pen.moveTo(...toScreen(map, from));
    pen.lineTo(...toScreen(map, to));
  };
  for (const at of x.ticks) {
    line([at, y.low, z.low], [at, y.high, z.low]);
    line([at, farY, z.low], [at, farY, z.high]);
  }
  for (const at of y.ticks) {
    line([x.low, at, z.low], [x.high, at, z.low]);
    line([farX, at, z.low], [farX, at, z.high]);
  }
  for (const at of z.ticks) {
    line([x.low, farY, at], [x.high, farY, at]);
    line([farX, y.low, at], [farX, y.high, at]);
  }
  pen.stroke();
}

/** @param inside  a pixel on the side of the edge that has no numbers */
function paintEdge(
  painted: Texts,
  axis: Axis,
  scale: AxisScale,
  pixelOf: (value: number) => Pixel,
  inside: Pixel,
): void {
  const { pen } = painted;
  const [from, to] = [pixelOf(scale.low), pixelOf(scale.high)];
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
  const length_px = Math.hypot(dx, dy);
  if (length_px < kLeastEdge_px) return;
  pen.strokeStyle = paint('var(--outline)');
  pen.beginPath();
  pen.moveTo(...from);
  pen.lineTo(...to);
  pen.stroke();
  const outwards = normalFrom(inside, from, [dx / length_px, dy / length_px]);
  align(pen, outwards);
  pen.fillStyle = paint('var(--muted)');
  const ticks = length_px < kShortEdge_px ? [scale.ticks[0], scale.ticks.at(-1)] : scale.ticks;
  const numbers = ticks.flatMap((value) =>
    value === undefined
      ? []
      : { text: tickText(value, scale.step), at: shifted(pixelOf(value), outwards, kGap_px) },
  );
  for (const { text, at } of numbers) painted.number(text, at);
  pen.fillStyle = paint('var(--text)');
  if (axis === 2) {
    pen.textAlign = 'center';
    pen.textBaseline = 'bottom';
    painted.name(kTitles[axis], shifted(to, [0, -1], 1.5 * kGap_px), [0, -1]);
    return;
  }
  const widest_px = Math.max(...numbers.map(({ text }) => pen.measureText(text).width));
  const beside_px = Math.abs(outwards[0]) > kSlant ? widest_px + kGap_px : kLine_px;
  const middle: Pixel = [(from[0] + to[0]) / 2, (from[1] + to[1]) / 2];
  painted.name(kTitles[axis], shifted(middle, outwards, kGap_px + beside_px), outwards);
}

interface Place {
  left: number;
  right: number;
  /** Of its middle. */
  y: number;
}

/** The numbers and names of all edges: none covers an earlier one. */
class Texts {
  private readonly places: Place[] = [];

  constructor(readonly pen: Pen) {}

  /** Left out where it would cover something. */
  number(text: string, at: Pixel): void {
    if (this.isFree(this.placeOf(text, at))) this.paint(text, at);
  }

  /** Farther away where it would cover something. */
  name(text: string, at: Pixel, outwards: Pixel): void {
    let place = at;
    const covers = () => !this.isFree(this.placeOf(text, place, kNameApart_px));
    for (let i = 0; i < kMostSteps && covers(); i += 1) {
      place = shifted(place, outwards, kStep_px);
    }
    this.paint(text, place);
  }

  private paint(text: string, at: Pixel): void {
    this.pen.fillText(text, ...at);
    this.places.push(this.placeOf(text, at));
  }

  private placeOf(text: string, [x, y]: Pixel, apart_px = kApart_px): Place {
    const { pen } = this;
    const width_px = pen.measureText(text).width;
    const before = { left: 0, center: 0.5, right: 1 }[pen.textAlign as 'left' | 'center' | 'right'];
    const left = x - before * width_px - apart_px;
    const right = left + width_px + 2 * apart_px;
    return { left, right, y: y + (kMiddle_px[pen.textBaseline] ?? 0) };
  }

  private isFree({ left, right, y }: Place): boolean {
    return this.places.every(
      (other) => left >= other.right || other.left >= right || Math.abs(y - other.y) >= kLine_px,
    );
  }
}

/** The unit vector across an edge, away from a pixel. */
function normalFrom(inside: Pixel, from: Pixel, [ux, uy]: Pixel): Pixel {
  const side = (inside[0] - from[0]) * -uy + (inside[1] - from[1]) * ux;
  return side > 0 ? [uy, -ux] : [-uy, ux];
}

function shifted([x, y]: Pixel, [ux, uy]: Pixel, by_px: number): Pixel {
  return [x + ux * by_px, y + uy * by_px];
}

/** Text that begins at a pixel and extends in a direction. */
function align(pen: Pen, [ux, uy]: Pixel): void {
  pen.textAlign = ux > kSlant ? 'left' : ux < -kSlant ? 'right' : 'center';
  pen.textBaseline = uy > kSlant ? 'top' : uy < -kSlant ? 'bottom' : 'middle';
}
