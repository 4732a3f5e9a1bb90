// One curve plot over time: truth and estimates of one axis, with a playback cursor. A click or
// drag seeks.
import uPlot from 'uplot';
import type { Axis } from '../store/run_data';
import { kAxes } from '../store/run_data';
import { estimateColour, kTruthColour } from './colours';
import { h, perFrame, setText } from './dom';
import { formatNumber } from '../store/format';
import type { Span } from '../store/time_window';
import { paddedRange } from './plot_range';

export interface PlotOptions {
  axis: Axis;
  label: string;
  unit: 'm' | 'deg';
  /** Whether the time axis has numbers. */
  timeLabels: boolean;
  estimators: number;
  onSeek: (t_s: number) => void;
  onHover: (index: number | null) => void;
  /** Above 1 shows more; 0 shows all. */
  onZoom: (centre_s: number, factor: number) => void;
}

const kGrid = 'rgba(140, 155, 180, 0.11)';
const kText = '#8a94a6';
const kFont = '10px system-ui, sans-serif';
// The truth lies below the estimates: it stays visible where they agree.
const kTruthWidth_px = 3;
const kEstimateWidth_px = 1.25;
const kZoom_per_px = 0.0015;
const kSyncKey = 'overfly-plots';
const kLeastSpan = { m: 2, deg: 4 } as const;

export type Curve = ArrayLike<number | null>;

export class Plot {
  readonly root: HTMLElement;
  private readonly plot: uPlot;
  private readonly area = h('div', { class: 'plot-area' });
  private readonly cursor = h('div', { class: 'plot-cursor' });
  private readonly readouts: HTMLElement[];
  private span_s: Span = [0, 1];
  private cursor_s: number | null = null;

  constructor(private readonly options: PlotOptions) {
    const colours = [
      kTruthColour,
      ...Array.from({ length: options.estimators }, (_, i) => estimateColour(i)),
    ];
    this.readouts = colours.map((colour) =>
      h('span', { class: 'readout', style: `color:${colour}` }),
    );
    const title = h(
      'div',
      { class: 'plot-title' },
      h('b', {}, options.label),
      h('span', { class: 'unit' }, options.unit),
      ...this.readouts,
    );
    this.root = h('div', { class: 'plot', 'data-axis': options.axis }, title, this.area);
    this.plot = new uPlot(this.uplotOptions(colours), [[], ...colours.map(() => [])], this.area);
    this.plot.over.append(this.cursor);
    this.seekable(this.plot.over);
    new ResizeObserver(() => this.fit()).observe(this.area);
  }

  setData(t_s: Float64Array, truth: Float64Array, estimates: Curve[], span_s: Span): void {
    this.span_s = span_s;
    // uPlot reads the series by index only; its type asks for one kind of array.
    this.plot.setData([t_s, truth, ...estimates] as unknown as uPlot.AlignedData, true);
  }

  moveCursor(t_s: number | null): void {
    this.cursor_s = t_s;
    this.placeCursor(this.plot);
  }

  /** Values beside the title: the truth's, then each estimate's. */
  showValues(values: (number | null | undefined)[]): void {
    const digits = this.options.unit === 'm' ? 1 : 2;
    this.readouts.forEach((readout, i) => setText(readout, formatNumber(values[i], digits)));
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

  private uplotOptions(colours: string[]): uPlot.Options {
    const axis = { stroke: kText, font: kFont, grid: { stroke: kGrid, width: 1 } };
    const { axis: name, timeLabels, onHover } = this.options;
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
        y: { range: (_, low, high) => paddedRange(low, high, kLeastSpan[this.options.unit]) },
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
          width: i === 0 ? kTruthWidth_px : kEstimateWidth_px,
          pxAlign: 0,
          points: { show: false },
        })),
      ],
      hooks: {
        // Only now the scales are those of the data.
        draw: [(plot: uPlot) => this.placeCursor(plot)],
        setCursor: [
          (plot: uPlot) => {
            // One plot speaks for all: the cursor is the same in each.
            if (name === kAxes[0]) onHover(plot.cursor.idx ?? null);
          },
        ],
      },
    };
  }
}
