// Paints the states of an estimate over time: a thin line while it tracks, in its colour, stripes while
// it initialises, a block while it is lost. The shapes tell them apart without their colours.
import type { Pen } from '../../store/plots/svg_pen';
import { kStateNames, stateName } from '../../store/state_spans';
import type { StateSpan } from '../../store/state_spans';
import { kStateColours } from '../colours';
import { h } from '../dom';
import { paint } from '../paint';

const kStripe_px = 2;
/** So that a state of one frame stays visible. */
const kLeast_px = 1;
/** Of the lane's height, while it tracks. */
const kThin = 0.4;
const kAlwaysNamed = ['INITIALISING', 'TRACKING', 'LOST'];

export interface LaneBox {
  left: number;
  right: number;
  top: number;
  height: number;
}

/** @param xOf  of a time of the run [ns] */
export function paintStateLane(
  pen: Pen,
  spans: readonly StateSpan[],
  colour: string,
  xOf: (t_ns: number) => number,
  { left, right, top, height }: LaneBox,
): void {
  for (const { state, begin_ns, end_ns } of spans) {
    const from = Math.max(left, xOf(begin_ns));
    const to = Math.min(right, Math.max(xOf(end_ns), from + kLeast_px));
    if (to <= from) continue;
    pen.fillStyle = paint(kStateColours[state] ?? 'var(--idle)');
    if (state === 'TRACKING') {
      pen.fillStyle = paint(colour);
      const thin = Math.max(1, height * kThin);
      pen.fillRect(from, top + (height - thin) / 2, to - from, thin);
    } else if (state === 'INITIALISING') {
      for (let x = from; x < to; x += 2 * kStripe_px) {
        pen.fillRect(x, top, Math.min(kStripe_px, to - x), height);
      }
    } else {
      pen.fillRect(from, top, to - from, height);
    }
  }
}

/** Names the shapes. @param states  that occur */
export function stateLegend(states: ReadonlySet<string>): HTMLElement[] {
  return Object.keys(kStateNames)
    .filter((state) => kAlwaysNamed.includes(state) || states.has(state))
    .map((state) =>
      h(
        'span',
        { 'data-state-name': state },
        h('i', { class: 'state-swatch', 'data-state': state }),
        stateName(state),
      ),
    );
}
