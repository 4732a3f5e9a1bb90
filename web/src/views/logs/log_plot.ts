// Curves of a log over the vehicle's time, with the flight modes behind them. A drag selects a slice.
import uPlot from 'uplot';
import type { Band, Mark } from '../../store/logs/log_bands';
import { bandHue, marksWithin } from '../../store/logs/log_bands';
import { formatNumber } from '../../store/format';
import { h, setText } from '../dom';
import { paint } from '../paint';
import { paddedRange } from '../../store/plots/plot_range';
import { axisNumbers, kValueAxis } from '../plots/axis_numbers';

export interface LogPlotOptions {
  key: string;
  label: string;
  unit: string;
  digits: number;
  least: number;
  timeLabels: boolean;
  /** One for each curve. */
  colours: readonly string[];
  /** In front of the values next to the title, one per curve. */
  names?: readonly string[];
  /** An angle that wraps: points, because a line would cross the plot. */
  dots: boolean;
  onHover: (t_s: number | null) => void;
  onSlice: (from_s: number, to_s: number) => void;
}

const kFont = '10px system-ui, sans-serif';
const kSyncKey = 'overfly-log-plots';
const kLeastSlice_px = 4;
const kDot_px = 2;

/** A sample off the curves; one outside of the axis is drawn at its edge. */
export interface Dot {
  t_s: number;
  value: number;
  colour: string;
}

export interface LogPlotData {
  t_s: number[];
  curves: (number | null)[][];
  dots: readonly Dot[];
  span_s: readonly [number, number];
  bands: readonly Band[];
  marks: readonly Mark[];
}

export class LogPlot {
  readonly root: HTMLElement;
  private readonly area = h('div', { class: 'plot-area' });
  private readonly readouts: HTMLElement[];
  private readonly plot: uPlot;
  private data: LogPlotData = {
    t_s: [],
    curves: [],
    dots: [],
    span_s: [0, 1],
    bands: [],
    marks: [],
  };
  private slice: readonly [number, number] | null = null;

  constructor(private readonly options: LogPlotOptions) {
    this.readouts = options.colours.map((colour) =>
      h('span', { class: 'readout', style: `color:${colour}` }),
    );
    const title = h(
      'div',
      { class: 'plot-title' },
      h('b', {}, options.label),
      h('span', { class: 'unit' }, options.unit),
      h('span', { class: 'readouts' }, ...this.readouts),
    );
    this.root = h('div', { class: 'plot', 'data-log-plot': options.key }, title, this.area);
    const none: [][] = [[], ...options.colours.map((): [] => [])];
    this.plot = new uPlot(this.uplotOptions(), none as unknown as uPlot.AlignedData, this.area);
    // When the mouse is gone this plot is no longer the one that reports.
    this.plot.over.addEventListener('mouseleave', () => options.onHover(null));
    new ResizeObserver(() => this.fit()).observe(this.area);
  }

  show(data: LogPlotData): void {
    this.data = data;
    this.plot.setData([data.t_s, ...data.curves], true);
    for (const readout of this.readouts) setText(readout, '');
  }

  showSlice(slice: readonly [number, number] | null): void {
    this.slice = slice;
    this.plot.redraw(false);
  }

  /** Draws the same again, in the colours of the theme. */
  repaint(): void {
    this.plot.redraw(false);
  }

  private fit(): void {
    const { clientWidth, clientHeight } = this.area;
    if (clientWidth < 20 || clientHeight < 20) return;
    this.plot.setSize({ width: clientWidth, height: clientHeight });
  }

  private uplotOptions(): uPlot.Options {
    const { timeLabels, least, colours, dots } = this.options;
    const axis = {
      stroke: () => paint('var(--muted)'),
      font: kFont,
      grid: { stroke: () => paint('var(--grid)'), width: 1 },
      ticks: { show: false },
    };
    return {
      width: 200,
      height: 60,
      padding: [8, 12, timeLabels ? 0 : 6, 0],
      legend: { show: false },
      cursor: {
        y: false,
        points: { show: false },
        drag: { x: true, y: false, setScale: false },
        sync: { key: kSyncKey, setSeries: false },
      },
      scales: {
        x: { time: false, range: () => [...this.data.span_s] },
        y: { range: (_, low, high) => paddedRange(low, high, least) },
      },
      axes: [
        timeLabels
          ? { ...axis, size: 20, gap: 2, values: axisNumbers, space: 50 }
          : { ...axis, size: 0, values: () => [], space: 50 },
        { ...axis, ...kValueAxis, size: 46, gap: 3 },
      ],
      series: [
        {},
        ...colours.map((colour) => ({
          stroke: () => paint(colour),
          width: dots ? 0 : 1.25,
          pxAlign: 0,
          points: { show: dots, size: 2, fill: () => paint(colour), width: 0 },
        })),
      ],
      hooks: {
        drawClear: [(plot: uPlot) => this.drawBands(plot)],
        draw: [(plot: uPlot) => this.drawDots(plot), (plot: uPlot) => this.drawSlice(plot)],
        setCursor: [(plot: uPlot) => this.hover(plot)],
        setSelect: [(plot: uPlot) => this.select(plot)],
      },
    };
  }

  private hover(plot: uPlot): void {
    const { idx, left } = plot.cursor;
    const { digits, names } = this.options;
    this.readouts.forEach((readout, i) => {
      const value = idx === null || idx === undefined ? null : this.data.curves[i]?.[idx];
      const name = names?.[i];
      const text = value === null || value === undefined ? '' : formatNumber(value, digits);
      setText(readout, text === '' || name === undefined ? text : `${name} ${text}`);
    });
    // Of the synchronised plots only the one under the mouse reports.
    if (!plot.over.matches(':hover')) return;
    this.options.onHover(left === undefined || left < 0 ? null : plot.posToVal(left, 'x'));
  }

  private select(plot: uPlot): void {
    const { left, width } = plot.select;
    if (width < kLeastSlice_px || !plot.over.matches(':hover, :active')) return;
    const from_s = plot.posToVal(left, 'x');
    const to_s = plot.posToVal(left + width, 'x');
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.options.onSlice(from_s, to_s);
  }

  private drawBands(plot: uPlot): void {
    const { ctx, bbox } = plot;
    const x = (t_s: number) =>
      Math.min(bbox.left + bbox.width, Math.max(bbox.left, plot.valToPos(t_s, 'x', true)));
    ctx.save();
    for (const { begin_s, end_s, text } of this.data.bands) {
      ctx.fillStyle = `hsla(${bandHue(text)}, 60%, 55%, 0.13)`;
      ctx.fillRect(x(begin_s), bbox.top, x(end_s) - x(begin_s), bbox.height);
    }
    ctx.strokeStyle = paint('color-mix(in srgb, var(--mission) 45%, transparent)');
    ctx.beginPath();
    for (const { t_s, kind } of marksWithin(this.data.marks, this.data.span_s)) {
      if (kind === 'text') continue;
      ctx.moveTo(x(t_s), bbox.top);
      ctx.lineTo(x(t_s), bbox.top + bbox.height);
    }
    ctx.stroke();
    ctx.restore();
  }

  private drawDots(plot: uPlot): void {
    const { ctx, bbox } = plot;
    const radius = kDot_px * window.devicePixelRatio;
    ctx.save();
    for (const { t_s, value, colour } of this.data.dots) {
      const x = plot.valToPos(t_s, 'x', true);
      if (x < bbox.left || x > bbox.left + bbox.width) continue;
      const y = plot.valToPos(value, 'y', true);
      const edge = Math.min(bbox.top + bbox.height, Math.max(bbox.top, y));
      ctx.fillStyle = paint(colour);
      ctx.beginPath();
      if (edge === y) {
        ctx.arc(x, y, radius, 0, 2 * Math.PI);
      } else {
        // Points to where the sample is.
        const tip = edge;
        const base = y < edge ? edge + 3 * radius : edge - 3 * radius;
        ctx.moveTo(x, tip);
        ctx.lineTo(x - 1.5 * radius, base);
        ctx.lineTo(x + 1.5 * radius, base);
      }
      ctx.fill();
    }
    ctx.restore();
  }

  /** Shades what lies outside of the slice. */
  private drawSlice(plot: uPlot): void {
    if (this.slice === null) return;
    const { ctx, bbox } = plot;
    const clamp = (x: number) => Math.min(bbox.left + bbox.width, Math.max(bbox.left, x));
    const from = clamp(plot.valToPos(this.slice[0], 'x', true));
    const to = clamp(plot.valToPos(this.slice[1], 'x', true));
    ctx.save();
    ctx.fillStyle = paint('var(--outside)');
    ctx.fillRect(bbox.left, bbox.top, from - bbox.left, bbox.height);
    ctx.fillRect(to, bbox.top, bbox.left + bbox.width - to, bbox.height);
    ctx.restore();
  }
}
