// One figure of the score over the length of sub-paths: a line with points for each estimate.
import { formatNumber } from '../../store/format';
import type { DriftSpec } from '../../store/plots/drift_specs';
import { driftAt, driftExtent, nearestLength } from '../../store/plots/drift_specs';
import type { Size } from '../../store/plots/path_frame';
import { ticks, tickText } from '../../store/plots/path_frame';
import type { SharedExtent } from '../../store/plots/shared_extent';
import { legendNames } from '../../store/plots/shared_extent';
import type { Pen } from '../../store/plots/svg_pen';
import { curveStyle } from '../colours';
import { h, perFrame, setAttribute } from '../dom';
import { paint } from '../paint';
import { BeyondNote } from './beyond_note';
import type { Drawing } from './plot_canvas';
import { PlotCanvas } from './plot_canvas';
import { plotTip } from './plot_tip';

const kLeft_px = 48;
const kRight_px = 16;
const kTopMargin_px = 8;
const kBottom_px = 34;
const kTickSpace_px = 70;
const kPoint_px = 3;
/** Beyond the largest values. */
const kMargin = 1.08;

export class DriftPlot {
  readonly root: HTMLElement;
  private readonly plot = new PlotCanvas((pen, size) => this.paintAll(pen, size), {
    width_px: 2 * kLeft_px,
    height_px: 2 * kBottom_px,
  });

  private readonly beyond = new BeyondNote();
  private shared: SharedExtent | null = null;

  constructor(private spec: DriftSpec) {
    this.plot.area.append(this.beyond.root);
    const { key, label, unit, hint } = spec;
    this.root = h(
      'div',
      { class: 'plot drift-plot', 'data-axis': key },
      h(
        'div',
        { class: 'plot-title', title: hint },
        h('b', {}, label),
        h('span', { class: 'unit' }, `${unit}, over the length of sub-paths`),
      ),
      this.plot.area,
    );
    const point = perFrame<PointerEvent | null>((event) => this.pointAt(event));
    this.plot.area.addEventListener('pointermove', (event) => point(event));
    this.plot.area.addEventListener('pointerleave', () => point(null));
  }

  /** Takes the figures as they are now. */
  draw(spec: DriftSpec): void {
    this.spec = spec;
    this.shared = driftExtent(spec);
    this.beyond.show(spec.curves.filter((_, i) => this.shared?.beyond.includes(i)));
    const { label, unit, digits, curves } = spec;
    const words = curves.map(({ name, lengths_m, values }) => {
      const figures = lengths_m.map((m, i) => `${formatNumber(values[i], digits)} at ${m} m`);
      return `${name} ${figures.join(', ')}`;
    });
    setAttribute(this.plot.canvas, 'aria-label', `${label} in ${unit}: ${words.join('; ')}`);
    this.repaint();
  }

  repaint(): void {
    this.plot.repaint();
  }

  /** As it is shown, drawn into a file. */
  drawing(): Drawing {
    const { label, unit, curves } = this.spec;
    const names = legendNames(curves, this.shared?.beyond ?? []);
    return this.plot.drawing(kLeft_px, `${label} [${unit}]`, names);
  }

  /** The greatest length and value of the axes, which begin at zero. */
  private ends(): { length_m: number; value: number } {
    const { curves, least } = this.spec;
    return {
      length_m: kMargin * Math.max(1, ...curves.flatMap(({ lengths_m }) => lengths_m)),
      value: kMargin * Math.max(least, this.shared?.high[0] ?? 0),
    };
  }

  private paintAll(pen: Pen, { width_px, height_px }: Size): void {
    const { length_m, value } = this.ends();
    const [width, height] = [
      width_px - kLeft_px - kRight_px,
      height_px - kTopMargin_px - kBottom_px,
    ];
    const x = (at_m: number) => kLeft_px + (at_m / length_m) * width;
    const y = (at: number) => kTopMargin_px + (1 - at / value) * height;
    paintAxes(pen, x, y, this.ends(), width, height);
    for (const { hue, lengths_m, values } of this.spec.curves) {
      const { colour, width_px: line_px, dash } = curveStyle(hue);
      pen.strokeStyle = pen.fillStyle = paint(colour);
      pen.lineWidth = line_px;
      pen.setLineDash(dash);
      pen.beginPath();
      lengths_m.forEach((at_m, i) => pen.lineTo(x(at_m), y(values[i] ?? NaN)));
      pen.stroke();
      pen.setLineDash([]);
      lengths_m.forEach((at_m, i) => {
        pen.beginPath();
        pen.arc(x(at_m), y(values[i] ?? NaN), kPoint_px, 0, 2 * Math.PI);
        pen.fill();
      });
    }
  }

  /** The values of all curves at the length that is nearest to the mouse. */
  private pointAt(event: PointerEvent | null): void {
    if (event === null || !this.root.isConnected) {
      plotTip.hide();
      return;
    }
    const { curves } = this.spec;
    const { width_px, height_px } = this.plot.size();
    const { left, top } = this.plot.area.getBoundingClientRect();
    const ends = this.ends();
    const share = (event.clientX - left - kLeft_px) / (width_px - kLeft_px - kRight_px);
    const length_m = nearestLength(curves, share * ends.length_m);
    if (length_m === null) return;
    const height = height_px - kTopMargin_px - kBottom_px;
    const below = (event.clientY - top - kTopMargin_px) / height;
    plotTip.show(
      this.spec,
      curves.map((curve) => driftAt(curve, length_m)),
      {
        x: event.clientX,
        y: event.clientY,
        place: `${length_m} m`,
        value: (1 - below) * ends.value,
        states: [],
      },
    );
  }
}

function paintAxes(
  pen: Pen,
  x: (length_m: number) => number,
  y: (value: number) => number,
  ends: { length_m: number; value: number },
  width: number,
  height: number,
): void {
  const lengths = ticks(0, ends.length_m, width / kTickSpace_px);
  const values = ticks(0, ends.value, height / (0.6 * kTickSpace_px));
  const bottom = kTopMargin_px + height;
  pen.strokeStyle = paint('var(--grid)');
  pen.lineWidth = 1;
  pen.beginPath();
  for (const at_m of lengths) {
    pen.moveTo(x(at_m), kTopMargin_px);
    pen.lineTo(x(at_m), bottom);
  }
  for (const value of values) {
    pen.moveTo(kLeft_px, y(value));
    pen.lineTo(kLeft_px + width, y(value));
  }
  pen.stroke();
  pen.fillStyle = paint('var(--muted)');
  pen.font = '10px system-ui, sans-serif';
  pen.textBaseline = 'alphabetic';
  const step = (list: number[]) => (list[1] ?? 1) - (list[0] ?? 0);
  pen.textAlign = 'center';
  for (const at_m of lengths) pen.fillText(tickText(at_m, step(lengths)), x(at_m), bottom + 13);
  pen.textAlign = 'right';
  for (const value of values) {
    pen.fillText(tickText(value, step(values)), kLeft_px - 5, y(value) + 3.5);
  }
  pen.fillText('length [m]', kLeft_px + width, bottom + 27);
}
