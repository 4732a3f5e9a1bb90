// What smoothing leaves of a log's samples: curves of those that were used, dots of the others.
import type { LogInfo, LogResiduals, LogSeries, ResidualTable } from '../../protocol/log_types';
import { eventsOf, modeBands } from '../../store/logs/log_bands';
import { broken } from '../../store/logs/log_track';
import type { LogSmoothingState } from '../../store/logs/log_smoothing';
import { h, rebuild, setText } from '../dom';
import type { Dot } from './log_plot';
import { LogPlot } from './log_plot';

const kColours = ['var(--axis-x)', 'var(--axis-y)', 'var(--axis-z)'] as const;
const kLeftOut = 'var(--left-out)';
const kShifted = 'var(--shifted)';
const kPlots = [
  {
    key: 'positions',
    label: 'Positions',
    unit: 'm',
    digits: 3,
    least: 0.1,
    columns: ['east_m', 'north_m', 'up_m'],
    names: ['E', 'N', 'U'],
  },
  {
    key: 'attitudes',
    label: 'Attitudes',
    unit: 'deg',
    digits: 3,
    least: 0.1,
    columns: ['x_deg', 'y_deg', 'z_deg'],
    names: ['x', 'y', 'z'],
  },
] as const;
const kSteps: Readonly<Record<string, string>> = {
  waiting: 'Waiting',
  reading: 'Reading the log',
  positions: 'Fitting the positions',
  attitudes: 'Fitting the attitudes',
};

export interface ResidualActions {
  onHover: (t_s: number | null) => void;
  onSlice: (from_s: number, to_s: number) => void;
  onCancel: () => void;
  onAgain: () => void;
}

export class LogResidualsView {
  readonly root: HTMLElement;
  private readonly plots: LogPlot[];
  private readonly summary = h('div', { class: 'residual-summary', 'data-role': 'residuals' });
  private readonly jumps = h('ul', { class: 'residual-jumps', 'data-role': 'jumps' });
  private readonly step = h('span', {});
  private readonly bar = h('div', { class: 'upload-bar' });
  private readonly work: HTMLElement;
  private readonly problem = h('span', {});
  private readonly failed: HTMLElement;
  private span_s: readonly [number, number] = [0, 1];
  private shown: { residuals: LogResiduals | null; series: LogSeries | null } = {
    residuals: null,
    series: null,
  };

  constructor(actions: ResidualActions) {
    this.plots = kPlots.map(
      (plot, i) =>
        new LogPlot({
          ...plot,
          key: `residual_${plot.key}`,
          colours: kColours,
          timeLabels: i === kPlots.length - 1,
          dots: false,
          onHover: actions.onHover,
          onSlice: (from_s, to_s) =>
            actions.onSlice(Math.max(from_s, this.span_s[0]), Math.min(to_s, this.span_s[1])),
        }),
    );
    const button = (text: string, onclick: () => void) =>
      h('button', { class: 'secondary', type: 'button', onclick }, text);
    this.work = h(
      'div',
      { class: 'residual-work', 'data-role': 'smoothing-work' },
      this.step,
      h('div', { class: 'upload-track' }, this.bar),
      button('Cancel', actions.onCancel),
    );
    this.failed = h(
      'div',
      { class: 'residual-work', 'data-role': 'smoothing-failed' },
      this.problem,
      button('Smooth again', actions.onAgain),
    );
    this.root = h(
      'div',
      { class: 'log-residuals', hidden: true },
      this.summary,
      ...this.plots.map(({ root }) => root),
      this.jumps,
      this.work,
      this.failed,
    );
  }

  show(state: LogSmoothingState, info: LogInfo | null, series: LogSeries | null): void {
    const { progress, residuals, error } = state;
    this.work.hidden = progress === null;
    if (progress !== null) {
      const percent = Math.round(100 * progress.share);
      setText(this.step, `${kSteps[progress.step] ?? progress.step}, ${percent} %`);
      this.bar.style.width = `${percent}%`;
    }
    this.failed.hidden = error === null;
    setText(this.problem, error ?? '');
    if (residuals === this.shown.residuals && series === this.shown.series) return;
    this.shown = { residuals, series };
    const times = series?.positions['t_s'] ?? [];
    this.span_s = spanOf(residuals) ?? [times[0] ?? 0, times.at(-1) ?? 1];
    const events = info === null || series === null ? [] : eventsOf(info.events, series);
    const bands = modeBands(events, this.span_s[1]);
    kPlots.forEach(({ key, columns }, i) => {
      const fit = residuals?.[key];
      const used = fit?.used ?? {};
      const lines = columns.map((name) => broken(used['t_s'] ?? [], used[name] ?? [], false));
      this.plots[i]?.show({
        t_s: lines[0]?.t_s ?? [],
        curves: lines.map(({ values }) => values),
        dots: [
          ...dotsOf(fit?.shifted ?? {}, columns, kShifted),
          ...dotsOf(fit?.left_out ?? {}, columns, kLeftOut),
        ],
        span_s: this.span_s,
        bands,
        marks: [],
      });
    });
    this.showTexts(residuals);
  }

  repaint(): void {
    for (const plot of this.plots) plot.repaint();
  }

  showSlice(slice: readonly [number, number] | null): void {
    for (const plot of this.plots) plot.showSlice(slice);
  }

  private showTexts(residuals: LogResiduals | null): void {
    rebuild(this.summary, String(Math.random()), () =>
      residuals === null ? [] : summaryOf(residuals).map((text) => h('span', {}, text)),
    );
    rebuild(this.jumps, String(Math.random()), () => {
      const texts = residuals?.jumps.map(({ text }) => text) ?? [];
      const more = (residuals?.jump_count ?? 0) - texts.length;
      if (more > 0) texts.push(`and ${more} more`);
      return texts.map((text) => h('li', {}, text));
    });
    this.jumps.hidden = (residuals?.jumps.length ?? 0) === 0;
  }
}

function spanOf(residuals: LogResiduals | null): readonly [number, number] | null {
  if (residuals === null) return null;
  const times = kPlots.flatMap(({ key }) => {
    const { used, left_out } = residuals[key];
    return [used, left_out].flatMap(({ t_s = [] }) => [t_s[0], t_s.at(-1)]);
  });
  const known = times.filter((t) => t !== undefined);
  return known.length === 0 ? null : [Math.min(...known), Math.max(...known)];
}

function dotsOf(table: ResidualTable, columns: readonly string[], colour: string): Dot[] {
  const { t_s = [] } = table;
  return columns.flatMap((name) =>
    t_s.map((time_s, i) => ({ t_s: time_s, value: table[name]?.[i] ?? 0, colour })),
  );
}

function summaryOf({ positions, attitudes, ...rest }: LogResiduals): string[] {
  const counts = ({
    used_count,
    left_out_count,
    shifted_count,
  }: typeof positions | typeof attitudes) =>
    `${used_count} used, ${left_out_count} left out` +
    (shifted_count > 0 ? `, ${shifted_count} shifted` : '');
  const sigma = rest.time_offset_sigma_s;
  return [
    `${positions.source}: ${positions.rms_m.toFixed(3)} m RMS, ${counts(positions)}`,
    `${attitudes.source}: ${attitudes.rms_deg.toFixed(3)} deg RMS, ${counts(attitudes)}`,
    ...(sigma === null
      ? []
      : [`time offset ${rest.time_offset_s.toFixed(3)} s ± ${sigma.toFixed(3)} s`]),
    ...rest.warnings,
  ];
}
