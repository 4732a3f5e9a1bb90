// The plots of a log, one below the other, with a lane that names the flight modes.
import type { LogInfo, LogSeries } from '../../protocol/log_types';
import { bandHue, eventsOf, marksOf, modeBands } from '../../store/logs/log_bands';
import type { Band, Mark } from '../../store/logs/log_bands';
import { broken } from '../../store/logs/log_track';
import { h, setText, wholeLabel } from '../dom';
import { LogPlot } from './log_plot';

interface Curve {
  key: string;
  label: string;
  unit: string;
  digits: number;
  least: number;
  wraps: boolean;
  table: 'positions' | 'speeds' | 'attitudes';
  /** The first that the table has. */
  columns: readonly string[];
}

const kCurves: readonly Curve[] = [
  {
    key: 'height',
    label: 'Height',
    unit: 'm',
    digits: 1,
    least: 5,
    wraps: false,
    table: 'positions',
    columns: ['alt_msl_m', 'alt_ellipsoid_m', 'above_origin_m'],
  },
  {
    key: 'speed',
    label: 'Ground speed',
    unit: 'm/s',
    digits: 1,
    least: 2,
    wraps: false,
    table: 'speeds',
    columns: ['ground_speed_m_s'],
  },
  ...(
    [
      ['roll', 'Roll'],
      ['pitch', 'Pitch'],
      ['yaw', 'Yaw'],
    ] as const
  ).map(([name, label]) => ({
    key: name,
    label,
    unit: 'deg',
    digits: 1,
    least: 5,
    wraps: name === 'yaw',
    table: 'attitudes' as const,
    columns: [`${name}_deg`],
  })),
];

const kHeightNames: Readonly<Record<string, string>> = {
  alt_msl_m: 'm above mean sea level',
  alt_ellipsoid_m: 'm above the ellipsoid',
  above_origin_m: 'm above the origin',
};
/** The text of events within this part of the time axis is shown. */
const kNear = 0.006;

export class LogCurves {
  readonly root: HTMLElement;
  private readonly lane = h('div', { class: 'mode-lane', 'data-role': 'mode-lane' });
  private readonly hint = h('div', { class: 'log-hint', 'data-role': 'log-hint' });
  private readonly plots: LogPlot[];
  private span_s: readonly [number, number] = [0, 1];
  private bands: Band[] = [];
  private marks: Mark[] = [];
  private shown: LogSeries | null = null;

  constructor(
    private readonly onHover: (t_s: number | null) => void,
    onSlice: (from_s: number, to_s: number) => void,
  ) {
    this.plots = kCurves.map(
      (curve, i) =>
        new LogPlot({
          ...curve,
          timeLabels: i === kCurves.length - 1,
          colours: ['var(--truth)'],
          dots: curve.wraps,
          onHover: (t_s) => this.hover(t_s),
          onSlice: (from_s, to_s) =>
            onSlice(Math.max(from_s, this.span_s[0]), Math.min(to_s, this.span_s[1])),
        }),
    );
    this.root = h(
      'div',
      { class: 'log-curves' },
      this.lane,
      ...this.plots.map(({ root }) => root),
      h('div', { class: 'log-axis' }, h('span', {}, 's of the vehicle’s clock'), this.hint),
    );
  }

  show(info: LogInfo | null, series: LogSeries | null): void {
    if (series === this.shown) return;
    this.shown = series;
    const times = series?.positions['t_s'] ?? [];
    this.span_s = [times[0] ?? 0, times.at(-1) ?? 1];
    const events = info === null || series === null ? [] : eventsOf(info.events, series);
    this.bands = modeBands(events, this.span_s[1]);
    this.marks = marksOf(events);
    kCurves.forEach((curve, i) => this.showCurve(curve, this.plots[i], series));
    this.drawLane();
  }

  repaint(): void {
    for (const plot of this.plots) plot.repaint();
  }

  showSlice(slice: readonly [number, number] | null): void {
    for (const plot of this.plots) plot.showSlice(slice);
  }

  private showCurve(curve: Curve, plot: LogPlot | undefined, series: LogSeries | null): void {
    if (plot === undefined) return;
    const table = series?.[curve.table] ?? {};
    const name = curve.columns.find((column) => column in table) ?? '';
    const lines = broken(table['t_s'] ?? [], table[name] ?? [], curve.wraps);
    plot.show({
      t_s: lines.t_s,
      curves: [lines.values],
      dots: [],
      span_s: this.span_s,
      bands: this.bands,
      marks: this.marks,
    });
    if (curve.key === 'height') {
      const unit = plot.root.querySelector<HTMLElement>('.unit');
      if (unit !== null) setText(unit, kHeightNames[name] ?? 'm');
    }
  }

  private drawLane(): void {
    const [begin, end] = this.span_s;
    const share = (t_s: number) => Math.min(1, Math.max(0, (t_s - begin) / (end - begin || 1)));
    this.lane.replaceChildren(
      ...this.bands
        .filter(({ begin_s, end_s }) => end_s > begin && begin_s < end)
        .map(({ begin_s, end_s, text }) =>
          h(
            'span',
            {
              class: 'mode-band',
              title: `${text}: ${begin_s.toFixed(1)} to ${end_s.toFixed(1)} s`,
              'data-mode': text,
              style:
                `left:${share(begin_s) * 100}%;width:${(share(end_s) - share(begin_s)) * 100}%;` +
                `background:hsla(${bandHue(text)}, 60%, 45%, 0.55)`,
            },
            wholeLabel(text),
          ),
        ),
    );
  }

  private hover(t_s: number | null): void {
    this.onHover(t_s);
    if (t_s === null) {
      setText(this.hint, '');
      return;
    }
    const near_s = (this.span_s[1] - this.span_s[0]) * kNear;
    const texts = this.marks
      .filter((mark) => Math.abs(mark.t_s - t_s) <= near_s)
      .slice(0, 3)
      .map(({ text }) => text);
    setText(this.hint, [`${t_s.toFixed(2)} s`, ...texts].join(' · '));
  }
}
