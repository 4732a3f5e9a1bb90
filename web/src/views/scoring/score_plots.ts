// The plots of scored trajectories, in groups of which one is shown.
import type { Evaluation } from '../../protocol/score_types';
import type { Path } from '../../store/plots/path_frame';
import type { DriftSpec } from '../../store/plots/drift_specs';
import { driftCsv } from '../../store/plots/drift_specs';
import type { PlotSpec } from '../../store/plots/plot_specs';
import type { ScoreGroup } from '../../store/scoring/score_specs';
import {
  pathMarks,
  scorePaths,
  scorePathsCsv,
  scoreDrifts,
  scoreSpan,
  scoreSpecs,
} from '../../store/scoring/score_specs';
import type { Span } from '../../store/playback/time_window';
import { panned, zoomed } from '../../store/playback/time_window';
import { h, rebuild } from '../dom';
import { DriftPlot } from '../plots/drift_plot';
import type { PathAxes } from '../plots/path_plot';
import { kPathAxes, PathPlot } from '../plots/path_plot';
import { sideBySide } from '../plots/plot_canvas';
import { PlotLegend } from '../plots/plot_legend';
import type { PlotActions } from '../plots/plot';
import { Plot } from '../plots/plot';
import type { PlotFile } from '../plots/plot_files';
import { saveMenu, timePlotsFile } from '../plots/plot_files';
import type { Context } from '../view';

const kGroups: readonly { name: ScoreGroup; label: string; hint: string; columns: number }[] = [
  { name: 'pose', label: 'Pose', hint: 'Positions and attitudes over time', columns: 3 },
  { name: 'path', label: 'Path', hint: 'The tracks from above and from the side', columns: 2 },
  { name: 'errors', label: 'Errors', hint: 'Errors over time', columns: 3 },
  { name: 'drift', label: 'Drift', hint: 'Relative errors by the length of the path', columns: 2 },
];

export class ScorePlots {
  readonly root: HTMLElement;
  private readonly grid = h('div', { class: 'plot-grid' });
  private readonly legend = new PlotLegend();
  readonly tabs = h('span', { class: 'tabs' });
  /** Of plots over time; the others name their axes. */
  readonly axis = h('span', { class: 'unit' }, 'over time [s]');
  readonly files: HTMLSelectElement;
  private group: ScoreGroup = 'errors';
  private plots: Plot[] = [];
  private drifts: DriftPlot[] = [];
  private readonly paths: readonly { plot: PathPlot; axes: PathAxes; tracks: Path[] }[];
  private drawn: { series: Evaluation | null; group: ScoreGroup } = { series: null, group: 'pose' };
  /** null = everything. */
  private window: Span | null = null;

  constructor(private readonly context: Context) {
    this.files = saveMenu(
      () => this.file(),
      (text) => context.notices.error(text),
    );
    this.paths = kPathAxes.map((axes) => ({
      plot: new PathPlot(axes, (t_s) => this.moveMarks(t_s)),
      axes,
      tracks: [],
    }));
    this.root = h('div', { class: 'score-plots' }, this.grid, this.legend.root);
    new ResizeObserver(() => this.draw()).observe(this.grid);
    this.drawTabs();
  }

  draw(): void {
    const { series } = this.scored();
    const { drawn, group } = this;
    if (drawn.series !== series || drawn.group !== group) {
      const other = drawn.series?.truth.name !== series?.truth.name || drawn.group !== group;
      if (other) this.window = null;
      this.drawn = { series, group };
      this.build();
    }
    const span = this.span();
    for (const plot of this.plots) plot.draw(span);
  }

  repaint(): void {
    for (const plot of this.plots) plot.repaint();
    for (const { plot } of this.paths) plot.repaint();
    for (const drift of this.drifts) drift.repaint();
  }

  /** Why there is no plot although there are scores; '' if there is. */
  emptyText(): string {
    if (this.group !== 'drift' || this.driftSpecs().length > 0) return '';
    return 'No trajectory has a scored path of 100 m.';
  }

  private scored(): { series: Evaluation | null; mode: string } {
    const { series } = this.context.store.state.scorePage;
    const [mode] = Object.keys(series?.estimates.find((one) => one.series)?.series ?? {});
    return { series: mode === undefined ? null : series, mode: mode ?? '' };
  }

  private specs(): PlotSpec[] {
    const { series, mode } = this.scored();
    return series === null ? [] : scoreSpecs(series, mode, this.group);
  }

  private driftSpecs(): DriftSpec[] {
    const { series, mode } = this.scored();
    return series === null ? [] : scoreDrifts(series, mode);
  }

  private whole(): Span {
    const { series } = this.scored();
    return series === null ? [0, 1] : scoreSpan(series);
  }

  private span(): Span {
    return this.window ?? this.whole();
  }

  private file(): PlotFile | null {
    const { series, mode } = this.scored();
    if (series === null) return null;
    const name = `scores-${this.group}`;
    if (this.group === 'path') {
      return {
        name,
        csv: () => scorePathsCsv(series, mode),
        svg: () => sideBySide(this.paths.map(({ plot }) => plot.drawing())),
      };
    }
    if (this.group === 'drift') {
      const drifts = this.driftSpecs();
      return {
        name,
        csv: () => driftCsv(drifts),
        svg: () => sideBySide(this.drifts.map((drift) => drift.drawing())),
      };
    }
    const specs = this.specs();
    if (specs.length === 0) return null;
    return timePlotsFile({ group: name, specs, span_s: this.span(), columns: this.columns() });
  }

  private columns(): number {
    return kGroups.find(({ name }) => name === this.group)?.columns ?? 1;
  }

  private build(): void {
    for (const plot of this.plots) plot.destroy();
    const moveTo = (t_s: number | null) => {
      for (const plot of this.plots) {
        plot.moveCursor(t_s);
        plot.showCursor(t_s);
      }
    };
    const actions: PlotActions = {
      onSeek: moveTo,
      onHover: moveTo,
      onZoom: (centre, factor) => this.move((span, whole) => zoomed(span, whole, centre, factor)),
      onPan: (by) => this.move((span, whole) => panned(span, whole, by)),
      onWhole: () => this.move(() => null),
    };
    const specs = this.specs();
    const columns = this.columns();
    this.plots = specs.map(
      (spec, i) =>
        new Plot(spec, actions, { timeLabels: i >= specs.length - columns, leads: i === 0 }),
    );
    if (this.group === 'path') this.takePaths();
    this.drifts = [];
    if (this.group === 'drift') {
      this.drifts = this.driftSpecs().map((spec) => {
        const drift = new DriftPlot(spec);
        drift.draw(spec);
        return drift;
      });
    }
    this.grid.style.setProperty('--columns', String(columns));
    this.grid.dataset['group'] = this.group;
    this.grid.dataset['alignment'] = this.scored().mode;
    const paths = this.group === 'path' ? this.paths.map(({ plot }) => plot) : [];
    const parts = [...paths, ...this.drifts, ...this.plots];
    this.grid.replaceChildren(...parts.map(({ root }) => root));
    this.axis.hidden = specs.length === 0;
    this.showLegend();
  }

  private showLegend(): void {
    const tracks =
      this.group === 'path' ? this.paths.map(({ tracks: curves }) => ({ curves })) : [];
    const drifts = this.group === 'drift' ? this.driftSpecs() : [];
    this.legend.show([...tracks, ...drifts, ...this.specs()]);
    this.root.classList.toggle('has-legend', !this.legend.root.hidden);
  }

  private takePaths(): void {
    const { series, mode } = this.scored();
    for (const path of this.paths) {
      const { across, up } = path.axes;
      path.tracks = series === null ? [] : scorePaths(series, mode, across, up);
      path.plot.setSubject(series?.truth.name ?? '');
      path.plot.show(path.tracks, []);
    }
  }

  /** Shows on both views where the tracks are. */
  private moveMarks(t_s: number): void {
    for (const { plot, tracks } of this.paths) plot.show(tracks, pathMarks(tracks, t_s));
  }

  /** Shows another part; null = everything. */
  private move(to: (span: Span, whole: Span) => Span | null): void {
    this.window = to(this.span(), this.whole());
    this.draw();
  }

  private drawTabs(): void {
    rebuild(this.tabs, this.group, () =>
      kGroups.map(({ name, label, hint }) =>
        h(
          'button',
          {
            class: 'tab',
            title: hint,
            'data-score-group': name,
            'aria-pressed': name === this.group ? 'true' : 'false',
            onclick: () => {
              this.group = name;
              this.drawTabs();
              this.context.store.change('scoring');
            },
          },
          label,
        ),
      ),
    );
  }
}
