// One plot of curves over time with a playback cursor. A click or drag seeks.
import uPlot from 'uplot';
import { h, perFrame, setText } from '../dom';
import { formatNumber } from '../../store/format';
import type { Span } from '../../store/time_window';
import { paddedRange } from './plot_range';

export interface PlotOptions {
  /** Identifies the plot in the page. */
  key: string;
  label: string;
  /** Explains the label. */
  hint?: string;
  unit: string;
  /** Digits of the values next to the title. */
  digits: number;
  /** Minimum span of the axis, so that noise does not fill the plot. */
  least: number;
  /** One for each curve. */
  colours: readonly string[];
  /** In front of the values next to the title, one per curve. */
  names?: readonly string[];
  /** The first curve is wider and lies below the others. */
  widensFirst: boolean;
  /** Whether the time axis has numbers. */
  timeLabels: boolean;
  /** Reports the mouse position for its group of plots. */
  leads: boolean;
  /** Lower limit of good values, drawn as a dashed line. */
  limit?: number;
  onSeek: (t_s: number) => void;
  onHover: (t_s: number | null) => void;
  /** A factor above 1 zooms in; 0 shows all. */
  onZoom: (centre_s: number, factor: number) => void;
}

const kGrid = 'rgba(140, 155, 180, 0.11)';
const kText = '#8a94a6';
const kFont = '10px system-ui, sans-serif';
// The truth lies below the estimates and stays visible where they agree.
const kTruthWidth_px = 3;
const kEstimateWidth_px = 1.25;
const kZoom_per_px = 0.0015;
const kSyncKey = 'overfly-plots';
const kLimitColour = '#eab766';

/** null breaks the line; undefined has no point and leaves the line as it is. */
export type Curve = ArrayLike<number | null | undefined>;

/** Up to three values start at the edge; more use separate rows, so that none is cut off. */
function crowding(curves: number): string {
  if (curves <= 2) return '';
  return curves === 3 ? ' crowded' : ' own-rows';
}

export class Plot {
  readonly root: HTMLElement;
  private readonly plot: uPlot;
  private readonly area = h('div', { class: 'plot-area' });
  private readonly cursor = h('div', { class: 'plot-cursor' });
  private readonly readouts: HTMLElement[];
  private span_s: Span = [0, 1];
  private cursor_s: number | null = null;

  constructor(private readonly options: PlotOptions) {
    const { colours } = options;
    this.readouts = colours.map((colour) =>
      h('span', { class: 'readout', style: `color:${colour}` }),
    );
    const title = h(
      'div',
      { class: `plot-title${crowding(colours.length)}`, title: options.hint },
      h('b', {}, options.label),
      h('span', { class: 'unit' }, options.unit),
      h('span', { class: 'readouts' }, ...this.readouts),
    );
    this.root = h('div', { class: 'plot', 'data-axis': options.key }, title, this.area);
    this.plot = new uPlot(this.uplotOptions(colours), [[], ...colours.map(() => [])], this.area);
    this.plot.over.append(this.cursor);
    this.seekable(this.plot.over);
    new ResizeObserver(() => this.fit()).observe(this.area);
  }

  /** @param curves  one per colour */
  setData(t_s: Float64Array, curves: Curve[], span_s: Span): void {
    this.span_s = span_s;
    // uPlot reads the series only by index; its type requires one kind of array.
    this.plot.setData([t_s, ...curves] as unknown as uPlot.AlignedData, true);
  }

  moveCursor(t_s: number | null): void {
    this.cursor_s = t_s;
    this.placeCursor(this.plot);
  }

  /** Values next to the title, one per curve. */
  showValues(values: (number | null | undefined)[]): void {
    const { digits, names } = this.options;
    this.readouts.forEach((readout, i) => {
      const name = names?.[i];
      const value = formatNumber(values[i], digits);
      setText(readout, name === undefined ? value : `${name} ${value}`);
    });
  }

  destroy(): void {
    this.plot.destroy();
  }

  private fit(): void {
    const { clientWidth, clientHeight } = this.area;
    if (clientWidth < 20 || clientHeight < 20) return;
    this.plot.setSize({ width: clientWidth, height: clientHeight });
  }

  private placeCursor(plot: uPlot): void {
    const x = this.cursor_s === null ? -1 : plot.valToPos(this.cursor_s, 'x');
    const visible = x >= 0 && x <= plot.over.clientWidth;
    this.cursor.style.visibility = visible ? 'visible' : 'hidden';
    if (visible) this.cursor.style.transform = `translateX(${x.toFixed(1)}px)`;
  }

  private seekable(over: HTMLElement): void {
    const seek = perFrame((x: number) => this.options.onSeek(this.plot.posToVal(x, 'x')));
    const seekTo = (event: PointerEvent) => seek(event.clientX - over.getBoundingClientRect().left);
    over.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      over.setPointerCapture(event.pointerId);
      seekTo(event);
    });
    over.addEventListener('pointermove', (event) => {
      if (over.hasPointerCapture(event.pointerId)) seekTo(event);
    });
    over.addEventListener(
      'wheel',
      (event) => {
        event.preventDefault();
        const x = event.clientX - over.getBoundingClientRect().left;
        this.options.onZoom(this.plot.posToVal(x, 'x'), Math.exp(event.deltaY * kZoom_per_px));
      },
      { passive: false },
    );
    over.addEventListener('dblclick', () => this.options.onZoom(0, 0));
    over.addEventListener('pointerleave', () => this.options.onHover(null));
  }

  private drawLimit(plot: uPlot): void {
    const { limit } = this.options;
    if (limit === undefined) return;
    const { left, width, top, height } = plot.bbox;
    const y = plot.valToPos(limit, 'y', true);
    if (y < top || y > top + height) return;
    plot.ctx.save();
    plot.ctx.strokeStyle = kLimitColour;
    plot.ctx.setLineDash([6, 4]);
    plot.ctx.beginPath();
    plot.ctx.moveTo(left, y);
    plot.ctx.lineTo(left + width, y);
    plot.ctx.stroke();
    plot.ctx.restore();
  }

  private uplotOptions(colours: readonly string[]): uPlot.Options {
    const axis = { stroke: kText, font: kFont, grid: { stroke: kGrid, width: 1 } };
    const { timeLabels, onHover, leads, least, widensFirst } = this.options;
    return {
      width: 200,
      height: 100,
      padding: [6, 12, timeLabels ? 0 : 4, 0],
      legend: { show: false },
      cursor: {
        y: false,
        points: { show: false },
        drag: { x: false, y: false, setScale: false },
        sync: { key: kSyncKey, setSeries: false },
      },
      scales: {
        x: { time: false, range: () => [...this.span_s] },
        y: { range: (_, low, high) => paddedRange(low, high, least) },
      },
      axes: [
        timeLabels
          ? { ...axis, size: 20, gap: 2, ticks: { show: false }, space: 44 }
          : { ...axis, size: 0, ticks: { show: false }, values: () => [], space: 44 },
        { ...axis, size: 40, gap: 3, ticks: { show: false }, space: 20 },
      ],
      series: [
        {},
        ...colours.map((stroke, i) => ({
          label: String(i),
          stroke,
          width: i === 0 && widensFirst ? kTruthWidth_px : kEstimateWidth_px,
          pxAlign: 0,
          points: { show: false },
        })),
      ],
      hooks: {
        // The scales match the data only now.
        draw: [(plot: uPlot) => this.placeCursor(plot), (plot: uPlot) => this.drawLimit(plot)],
        setCursor: [
          (plot: uPlot) => {
            const { left } = plot.cursor;
            if (!leads) return;
            onHover(left === undefined || left < 0 ? null : plot.posToVal(left, 'x'));
          },
        ],
      },
    };
  }
}
