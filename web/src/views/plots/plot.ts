// One plot of curves over time with a playback cursor. A click or drag seeks.
import uPlot from 'uplot';
import { curveStyle } from '../colours';
import { h, promptlyPerFrame, setText } from '../dom';
import { paint } from '../paint';
import { formatNumber } from '../../store/format';
import type { Polyline } from '../../store/plots/curve';
import { decimated, valueAt } from '../../store/plots/curve';
import { paddedRange } from '../../store/plots/plot_range';
import type { PlotSpec } from '../../store/plots/plot_specs';
import type { Span } from '../../store/time_window';

export interface PlotActions {
  onSeek: (t_s: number) => void;
  onHover: (t_s: number | null) => void;
  /** A factor above 1 zooms in; 0 shows all. */
  onZoom: (centre_s: number, factor: number) => void;
}

const kFont = '10px system-ui, sans-serif';
const kZoom_per_px = 0.0015;
/** Beyond this many, the values of all curves do not fit next to the title. */
const kMostReadouts = 6;
const kSyncKey = 'overfly-plots';

/** Width of the plotting area, from uPlot's own numbers: asking the element causes a layout. */
function plotWidth_px(plot: uPlot): number {
  return plot.bbox.width / uPlot.pxRatio;
}

function unitText({ unit, over }: PlotSpec): string {
  return over === undefined ? unit : `${unit} over ${over.label}`;
}

/** Up to three values start at the edge; more use separate rows, so that none is cut off. */
function crowding(curves: PlotSpec['curves']): string {
  if (curves.length > kMostReadouts) return '';
  const named = curves.some(({ short }) => short !== '');
  if (curves.length > 3 || (named && curves.length === 2)) return ' own-rows';
  return curves.length === 3 ? ' crowded' : '';
}

export class Plot {
  readonly root: HTMLElement;
  private readonly plot: uPlot;
  private readonly area = h('div', { class: 'plot-area' });
  private readonly cursor = h('div', { class: 'plot-cursor' });
  private readonly readouts: HTMLElement[];
  private lines: Polyline[] = [];
  private span_s: Span = [0, 1];
  private range: [number, number] = [0, 1];
  private cursor_s: number | null = null;

  /**
   * @param timeLabels  whether the time axis has numbers
   * @param leads  reports the mouse position for its group of plots
   */
  constructor(
    private readonly spec: PlotSpec,
    private readonly actions: PlotActions,
    { timeLabels, leads }: { timeLabels: boolean; leads: boolean },
  ) {
    const { curves } = spec;
    const shown = curves.length > kMostReadouts ? [] : curves;
    this.readouts = shown.map(({ hue, name }) =>
      h('span', { class: 'readout', style: `color:${curveStyle(hue).colour}`, title: name }),
    );
    const title = h(
      'div',
      { class: `plot-title${crowding(curves)}`, title: spec.hint },
      h('b', {}, spec.label),
      h('span', { class: 'unit' }, unitText(spec)),
      h('span', { class: 'readouts' }, ...this.readouts),
    );
    this.root = h('div', { class: 'plot', 'data-axis': spec.key }, title, this.area);
    const data = [[0, 1], ...curves.map(() => [null, null])] as uPlot.AlignedData;
    this.plot = new uPlot(this.uplotOptions(timeLabels, leads), data, this.area);
    this.plot.over.append(this.cursor);
    this.seekable(this.plot.over);
    new ResizeObserver(() => this.fit()).observe(this.area);
  }

  /** Draws the curves as they are now in a span of time. */
  draw(span_s: Span): void {
    const { curves, least } = this.spec;
    const pixels = Math.max(100, plotWidth_px(this.plot));
    this.span_s = span_s;
    this.lines = curves.map(({ curve }) => {
      const now = curve();
      return now === null ? { t_s: [], values: [] } : decimated(now, span_s, pixels);
    });
    this.range = paddedRange(...this.extremes(), least);
    const ends = [...span_s];
    // uPlot draws the axes for these two times; the curves are drawn by `path`.
    this.plot.setData([ends, ...curves.map(() => [null, null])] as uPlot.AlignedData, true);
  }

  /** Draws the same again, in the colours of the theme. */
  repaint(): void {
    this.plot.redraw(false);
  }

  moveCursor(t_s: number | null): void {
    this.cursor_s = t_s;
    this.placeCursor(this.plot);
  }

  /** Values at the clock's time; null = none. */
  showCursor(t_s: number | null): void {
    this.showValues(
      this.spec.curves.map(({ atClock, curve }) => {
        if (atClock !== undefined) return atClock() ?? null;
        const now = t_s === null ? null : curve();
        return now === null || t_s === null ? null : valueAt(now, t_s);
      }),
    );
  }

  /** Values at the time under the mouse. */
  showHover(t_s: number): void {
    this.showValues(
      this.spec.curves.map(({ curve }) => {
        const now = curve();
        return now === null ? null : valueAt(now, t_s);
      }),
    );
  }

  destroy(): void {
    this.plot.destroy();
  }

  private showValues(values: (number | null)[]): void {
    const { digits, curves } = this.spec;
    this.readouts.forEach((readout, i) => {
      const value = formatNumber(values[i], digits);
      const short = curves[i]?.short ?? '';
      setText(readout, short === '' ? value : `${short} ${value}`);
    });
  }

  /** The smallest and the largest value in the span. */
  private extremes(): [number, number] {
    let low = Infinity;
    let high = -Infinity;
    for (const { t_s, values } of this.lines) {
      values.forEach((value, i) => {
        const t = t_s[i] ?? NaN;
        if (t < this.span_s[0] || t > this.span_s[1]) return;
        if (value < low) low = value;
        if (value > high) high = value;
      });
    }
    return [low, high];
  }

  private path(plot: uPlot, line: Polyline | undefined): uPlot.Series.Paths {
    const stroke = new Path2D();
    let drawing = false;
    line?.t_s.forEach((t_s, i) => {
      const value = line.values[i] ?? NaN;
      if (Number.isNaN(value)) {
        drawing = false;
        return;
      }
      const x = plot.valToPos(t_s, 'x', true);
      const y = plot.valToPos(value, 'y', true);
      if (drawing) stroke.lineTo(x, y);
      else stroke.moveTo(x, y);
      // A single point is drawn as well.
      if (!drawing) stroke.lineTo(x + 0.01, y);
      drawing = true;
    });
    return { stroke };
  }

  private fit(): void {
    const { clientWidth, clientHeight } = this.area;
    if (clientWidth < 20 || clientHeight < 20) return;
    this.plot.setSize({ width: clientWidth, height: clientHeight });
  }

  private placeCursor(plot: uPlot): void {
    const x = this.cursor_s === null ? -1 : plot.valToPos(this.cursor_s, 'x');
    const visible = x >= 0 && x <= plotWidth_px(plot);
    this.cursor.style.visibility = visible ? 'visible' : 'hidden';
    if (visible) this.cursor.style.transform = `translateX(${x.toFixed(1)}px)`;
  }

  private seekable(over: HTMLElement): void {
    const seek = promptlyPerFrame((x: number) => this.actions.onSeek(this.plot.posToVal(x, 'x')));
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
        this.actions.onZoom(this.plot.posToVal(x, 'x'), Math.exp(event.deltaY * kZoom_per_px));
      },
      { passive: false },
    );
    over.addEventListener('dblclick', () => this.actions.onZoom(0, 0));
    over.addEventListener('pointerleave', () => this.actions.onHover(null));
  }

  private drawLimit(plot: uPlot): void {
    const { limit } = this.spec;
    if (limit === undefined) return;
    const { left, width, top, height } = plot.bbox;
    const y = plot.valToPos(limit, 'y', true);
    if (y < top || y > top + height) return;
    plot.ctx.save();
    plot.ctx.strokeStyle = paint('var(--limit)');
    plot.ctx.setLineDash([6, 4]);
    plot.ctx.beginPath();
    plot.ctx.moveTo(left, y);
    plot.ctx.lineTo(left + width, y);
    plot.ctx.stroke();
    plot.ctx.restore();
  }

  private uplotOptions(timeLabels: boolean, leads: boolean): uPlot.Options {
    const axis = {
      stroke: () => paint('var(--muted)'),
      font: kFont,
      grid: { stroke: () => paint('var(--grid)'), width: 1 },
    };
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
        y: { range: () => this.range },
      },
      axes: [
        timeLabels
          ? { ...axis, size: 20, gap: 2, ticks: { show: false }, space: 44 }
          : { ...axis, size: 0, ticks: { show: false }, values: () => [], space: 44 },
        { ...axis, size: 40, gap: 3, ticks: { show: false }, space: 20 },
      ],
      series: [
        {},
        ...this.spec.curves.map(({ hue, name }, i) => {
          const { colour, width_px, dash } = curveStyle(hue);
          return {
            label: name,
            stroke: () => paint(colour),
            width: width_px,
            dash,
            paths: (plot: uPlot) => this.path(plot, this.lines[i]),
            points: { show: false },
          };
        }),
      ],
      hooks: {
        // The scales match the data only now.
        draw: [(plot: uPlot) => this.placeCursor(plot), (plot: uPlot) => this.drawLimit(plot)],
        setCursor: [
          (plot: uPlot) => {
            const { left } = plot.cursor;
            if (!leads) return;
            this.actions.onHover(left === undefined || left < 0 ? null : plot.posToVal(left, 'x'));
          },
        ],
      },
    };
  }
}
