// One plot of curves over time with a playback cursor.
import uPlot from 'uplot';
import { curveStyle } from '../colours';
import { h, perFrame, setText } from '../dom';
import { paint } from '../paint';
import { formatNumber, formatTime } from '../../store/format';
import type { Polyline } from '../../store/plots/curve';
import { valueAt } from '../../store/plots/curve';
import { CurveWindow } from '../../store/plots/curve_window';
import { paddedRange } from '../../store/plots/plot_range';
import type { PlotSpec } from '../../store/plots/plot_specs';
import { curveExtent, sharedExtent } from '../../store/plots/shared_extent';
import { spanAt, stateName } from '../../store/state_spans';
import type { Span } from '../../store/playback/time_window';
import { axisNumbers, kValueAxis } from './axis_numbers';
import { BeyondNote } from './beyond_note';
import { paintCurves } from './curve_painter';
import { plotTip } from './plot_tip';
import { paintStateLane } from '../status/state_lanes';
import { steerTime } from './time_gestures';

export interface PlotActions {
  onSeek: (t_s: number) => void;
  onHover: (t_s: number | null) => void;
  /** A factor below 1 shows less. */
  onZoom: (centre_s: number, factor: number) => void;
  /** To later times, or to earlier ones. */
  onPan: (by_s: number) => void;
  onWhole: () => void;
}

const kFont = '10px system-ui, sans-serif';
/** Beyond this many, the values of all curves are reached by scrolling. */
const kMostReadouts = 6;
/** Of the curves. What does not fit into the panel then is reached by scrolling. */
const kLeastCurves_px = 60;
/** Above the curves, and below them or the lanes. */
const kPadding_px = 10;
const kTimeLabels_px = 20;
/** Of the lanes with the estimators' states. */
const kLane_px = 5;
const kMostLanes_px = 24;
const kLanesGap_px = 2;
/** Of a lane; the rest sets it off from the next one. */
const kLaneFilled = 0.8;
const kNoLine: Polyline = { t_s: [], values: [] };
const kSyncKey = 'overfly-plots';

/** Width of the plotting area, from uPlot's own numbers: asking the element causes a layout. */
function plotWidth_px(plot: uPlot): number {
  return plot.bbox.width / uPlot.pxRatio;
}

/** uPlot draws the axes for two times without values. */
function axesData(span_s: Span): uPlot.AlignedData {
  return [[...span_s], [null, null]];
}

function laneHeight_px(lanes: number): number {
  return Math.min(kLane_px, kMostLanes_px / Math.max(1, lanes));
}

/** Of all lanes with the space above them. */
function lanesHeight_px(lanes: number): number {
  return lanes === 0 ? 0 : Math.ceil(lanes * laneHeight_px(lanes)) + kLanesGap_px;
}

/** Up to three values start at the edge; more use separate rows, so that none is cut off. */
function crowding(curves: PlotSpec['curves']): string {
  if (curves.length > kMostReadouts) return ' own-rows many';
  const named = curves.some(({ short }) => short !== '');
  if (curves.length > 3 || (named && curves.length === 2)) return ' own-rows';
  return curves.length === 3 ? ' crowded' : '';
}

export class Plot {
  readonly root: HTMLElement;
  private readonly plot: uPlot;
  private readonly area: HTMLElement;
  private readonly cursor = h('div', { class: 'plot-cursor' });
  private readonly beyond = new BeyondNote();
  private readonly readouts: HTMLElement[];
  private lines: Polyline[] = [];
  private readonly windows: readonly CurveWindow[];
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
    this.windows = curves.map(() => new CurveWindow());
    this.readouts = curves.map(({ hue, name }) =>
      h('span', { class: 'readout', style: `color:${curveStyle(hue).colour}`, title: name }),
    );
    const title = h(
      'div',
      { class: `plot-title${crowding(curves)}`, title: spec.hint },
      h('b', {}, spec.label),
      h('span', { class: 'unit' }, spec.unit),
      h('span', { class: 'readouts' }, ...this.readouts),
    );
    const below_px = lanesHeight_px(spec.lanes?.length ?? 0) + (timeLabels ? kTimeLabels_px : 0);
    this.area = h('div', {
      class: 'plot-area',
      style: `min-height:${kLeastCurves_px + kPadding_px + below_px}px`,
    });
    this.root = h('div', { class: 'plot', 'data-axis': spec.key }, title, this.area);
    this.plot = new uPlot(this.uplotOptions(timeLabels, leads), axesData([0, 1]), this.area);
    this.plot.over.append(this.cursor, this.beyond.root);
    this.steer(this.plot.over);
    new ResizeObserver(() => this.fit()).observe(this.area);
  }

  /** Draws the curves as they are now in a span of time. */
  draw(span_s: Span): void {
    const { curves, least, unbounded } = this.spec;
    const pixels = Math.max(100, plotWidth_px(this.plot));
    this.span_s = span_s;
    this.lines = curves.map(({ curve }, i) => {
      const now = curve();
      return now === null ? kNoLine : (this.windows[i]?.at(now, span_s, pixels) ?? kNoLine);
    });
    const extents = this.lines.map((line, i) =>
      curveExtent(line, span_s, unbounded === true && curves[i]?.hue.kind === 'estimate'),
    );
    const shared = sharedExtent(extents, least);
    this.range = paddedRange(shared?.low[0] ?? Infinity, shared?.high[0] ?? -Infinity, least);
    this.beyond.show(curves.filter((_, i) => shared?.beyond.includes(i)));
    this.plot.setData(axesData(span_s), true);
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
    this.showValues(this.valuesAt(t_s));
  }

  destroy(): void {
    plotTip.hide();
    this.plot.destroy();
  }

  private valuesAt(t_s: number): (number | null)[] {
    return this.spec.curves.map(({ curve }) => {
      const now = curve();
      return now === null ? null : valueAt(now, t_s);
    });
  }

  private showValues(values: (number | null)[]): void {
    const { digits, curves } = this.spec;
    this.readouts.forEach((readout, i) => {
      const value = formatNumber(values[i], digits);
      const short = curves[i]?.short ?? '';
      setText(readout, short === '' ? value : `${short} ${value}`);
    });
  }

  private paintCurves({ ctx, bbox }: uPlot): void {
    const [begin_s, end_s] = this.span_s;
    const [least, greatest] = this.range;
    const scale = {
      left: bbox.left,
      top: bbox.top,
      begin_s,
      greatest,
      px_per_s: bbox.width / (end_s - begin_s),
      px_per_unit: bbox.height / (greatest - least),
    };
    paintCurves(ctx, this.spec.curves, this.lines, bbox, scale, uPlot.pxRatio);
  }

  /** Between the curves and the numbers of the time axis. */
  private paintLanes({ ctx, bbox }: uPlot): void {
    const ratio = uPlot.pxRatio;
    const lanes = this.spec.lanes ?? [];
    const height = laneHeight_px(lanes.length) * ratio;
    const [begin_s, end_s] = this.span_s;
    const right = bbox.left + bbox.width;
    ctx.save();
    lanes.forEach(({ spans, hue, offset_s }, i) => {
      const xOf = (t_ns: number) =>
        bbox.left + ((t_ns / 1e9 + offset_s() - begin_s) / (end_s - begin_s)) * bbox.width;
      const top = Math.round(bbox.top + bbox.height + kLanesGap_px * ratio + i * height);
      const box = {
        left: bbox.left,
        right,
        top,
        height: Math.max(1, Math.round(height * kLaneFilled)),
      };
      paintStateLane(ctx, spans(), curveStyle(hue).colour, xOf, box);
    });
    ctx.restore();
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

  private steer(over: HTMLElement): void {
    const { onSeek, onZoom, onPan, onWhole, onHover } = this.actions;
    const timeAt = (x_px: number) => this.plot.posToVal(x_px, 'x');
    steerTime(over, {
      seek: (x_px) => onSeek(timeAt(x_px)),
      zoom: (x_px, factor) => onZoom(timeAt(x_px), factor),
      pan: (dx_px) => {
        const [low, high] = this.span_s;
        onPan((-dx_px * (high - low)) / plotWidth_px(this.plot));
      },
      showWhole: onWhole,
    });
    const point = perFrame((event: PointerEvent | null) => this.pointAt(event));
    over.addEventListener('pointermove', (event) => point(event));
    over.addEventListener('pointerleave', () => {
      onHover(null);
      point(null);
    });
  }

  /** A plot with one curve has its value next to its title. */
  private pointAt(event: PointerEvent | null): void {
    const { spec, plot } = this;
    const steers = (event?.buttons ?? 0) !== 0;
    if (event === null || steers || spec.curves.length < 2 || !this.root.isConnected) {
      plotTip.hide();
      return;
    }
    const { left, top } = plot.over.getBoundingClientRect();
    const t_s = plot.posToVal(event.clientX - left, 'x');
    plotTip.show(spec, this.valuesAt(t_s), {
      x: event.clientX,
      y: event.clientY,
      place: formatTime(t_s * 1e9),
      value: plot.posToVal(event.clientY - top, 'y'),
      states: this.unusualStates(t_s),
    });
  }

  /** Of the estimators that do not track at a time. */
  private unusualStates(t_s: number): string[] {
    return (this.spec.lanes ?? []).flatMap(({ name, spans, offset_s }) => {
      const state = spanAt(spans(), (t_s - offset_s()) * 1e9)?.state ?? 'TRACKING';
      return state === 'TRACKING' ? [] : `${name}: ${stateName(state)}`;
    });
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
    const lanes = lanesHeight_px(this.spec.lanes?.length ?? 0);
    const axis = {
      stroke: () => paint('var(--muted)'),
      font: kFont,
      grid: { stroke: () => paint('var(--grid)'), width: 1 },
      ticks: { show: false },
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
          ? {
              ...axis,
              size: kTimeLabels_px + lanes,
              gap: 2 + lanes,
              values: axisNumbers,
              space: 44,
            }
          : { ...axis, size: lanes, values: () => [], space: 44 },
        { ...axis, ...kValueAxis, size: 40, gap: 3 },
      ],
      // uPlot draws the axes; the curves are drawn over them.
      series: [{}, { paths: () => null, points: { show: false } }],
      hooks: {
        draw: [
          (plot: uPlot) => this.paintCurves(plot),
          (plot: uPlot) => this.drawLimit(plot),
          (plot: uPlot) => this.paintLanes(plot),
          // The scales match the data only now.
          (plot: uPlot) => this.placeCursor(plot),
        ],
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
