// Paints where every aircraft is at the clock's time, with its attitude, and the errors there.
import type { BodyAxes } from '../../store/plot3d/attitude';
import type { Point3 } from '../../store/plot3d/axis_box';
import type { OrbitView, ScreenMap } from '../../store/plot3d/orbit_view';
import { screenAxes, toScreen } from '../../store/plot3d/orbit_view';
import type { Pen } from '../../store/plots/svg_pen';
import { paint } from '../paint';

/** An aircraft at the clock's time. */
export interface Mark {
  /** Of its track. */
  label: string;
  place: Point3;
  axes: BodyAxes;
  /** As in a style sheet. */
  colour: string;
  truth: boolean;
  /** Of its run; '' if one run is shown. */
  letter: string;
  /** Where its truth is; null for a truth, and where it has none. */
  truthPlace: Point3 | null;
}

type Pixel = [number, number];

/** Half the length of an aircraft. */
const kTruth_px = 17;
const kEstimate_px = 13;
/** Sets an aircraft off from its track. */
const kMargin_px = 3.5;
/** Seen from its edge a shape is a line. */
const kEdge_px = 1.25;

/** From above: forward and right, in halves of the length. */
const kPlan: readonly Pixel[] = [
  [1, 0],
  [0.75, 0.09],
  [0.3, 0.11],
  [0.22, 1.05],
  [-0.08, 1.05],
  [-0.16, 0.1],
  [-0.72, 0.06],
  [-0.8, 0.4],
  [-0.98, 0.4],
  [-0.98, 0],
];
const kFin: readonly Pixel[] = [
  [-0.6, 0],
  [-0.88, 0.42],
  [-1.02, 0.42],
  [-0.98, 0],
];

export function paintMarks(
  pen: Pen,
  marks: readonly Mark[],
  view: OrbitView,
  map: ScreenMap,
  options: { floor_m: number; errorLines: boolean },
): void {
  pen.lineWidth = 1;
  for (const { place, truth } of marks) {
    if (truth) paintLine(pen, map, place, [place[0], place[1], options.floor_m], 'var(--outline)');
  }
  if (options.errorLines) {
    for (const { place, truthPlace, colour } of marks) {
      if (truthPlace !== null) paintLine(pen, map, truthPlace, place, colour);
    }
  }
  for (const mark of marks) paintAircraft(pen, mark, view, map);
}

function paintLine(pen: Pen, map: ScreenMap, from: Point3, to: Point3, colour: string): void {
  pen.strokeStyle = paint(colour);
  pen.beginPath();
  pen.moveTo(...toScreen(map, from));
  pen.lineTo(...toScreen(map, to));
  pen.stroke();
}

function paintAircraft(
  pen: Pen,
  { place, axes, colour, truth, letter }: Mark,
  view: OrbitView,
  map: ScreenMap,
): void {
  const at = toScreen(map, place);
  const { plan, fin, fromAbove } = aircraftShape(axes, view, truth ? kTruth_px : kEstimate_px);
  const shapes = fromAbove ? [plan, fin] : [fin, plan];
  const trace = (shape: Pixel[]) => {
    pen.beginPath();
    for (const [x, y] of shape) pen.lineTo(at[0] + x, at[1] + y);
    pen.closePath();
  };
  pen.lineJoin = 'round';
  pen.strokeStyle = paint('var(--panel)');
  pen.lineWidth = kMargin_px;
  for (const shape of shapes) {
    trace(shape);
    pen.stroke();
  }
  pen.fillStyle = pen.strokeStyle = paint(colour);
  pen.lineWidth = kEdge_px;
  for (const shape of shapes) {
    trace(shape);
    pen.fill();
    pen.stroke();
  }
  if (letter === '') return;
  pen.font = '600 11px system-ui, sans-serif';
  pen.textAlign = 'left';
  pen.textBaseline = 'bottom';
  pen.fillText(letter, at[0] + kTruth_px * 0.8, at[1] - kTruth_px * 0.8);
}

/** An aircraft as it is seen, relative to its place [px, x right, y down]. */
export function aircraftShape(
  { forward, right, down }: BodyAxes,
  view: OrbitView,
  half_px: number,
): { plan: Pixel[]; fin: Pixel[]; fromAbove: boolean } {
  const screen = screenAxes(view);
  const pixelOf = (axis: Point3): Pixel => [
    dot(axis, screen.right) * half_px,
    -dot(axis, screen.up) * half_px,
  ];
  const [ahead, across, below] = [pixelOf(forward), pixelOf(right), pixelOf(down)];
  const at = (a: number, b: number, other: Pixel): Pixel => [
    a * ahead[0] + b * other[0],
    a * ahead[1] + b * other[1],
  ];
  const starboard = kPlan.map(([a, b]) => at(a, b, across));
  const port = kPlan.map(([a, b]) => at(a, -b, across)).reverse();
  return {
    plan: [...starboard, ...port],
    fin: kFin.map(([a, b]) => at(a, -b, below)),
    fromAbove: dot(down, screen.ahead) >= 0,
  };
}

function dot(a: Point3, b: Point3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
