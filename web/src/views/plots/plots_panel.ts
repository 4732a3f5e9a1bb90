// Plots over time, drawn at most 15 times a second: the pose, the camera's image or the sensors; or
// instead the status of the estimators.
import { needsAttention } from '../../store/estimator_status';
import { formatTime } from '../../store/format';
import type { DriftSpec } from '../../store/plots/drift_specs';
import { driftCsv, driftSpecs } from '../../store/plots/drift_specs';
import type { PlotSpec } from '../../store/plots/plot_specs';
import { groupOf, plotSpecs } from '../../store/plots/plot_specs';
import { tracksCsv } from '../../store/plots/track_files';
import type { Topic } from '../../store/state';
import { shownAlignment } from '../../store/state';
import { kPanels } from '../../store/layouts/panel_names';
import { AlignmentLegend } from '../alignment_legend';
import { EstimatorTable } from '../status/estimator_table';
import { h, rebuild, setAttribute, setText } from '../dom';
import type { Panel } from '../panel';
import { frameOf, makePanel } from '../panel';
import { DriftPlot } from './drift_plot';
import type { PlotActions } from './plot';
import { takeTimeKeys } from './time_commands';
import { Plot } from './plot';
import { kPathAxes, PathPlot } from './path_plot';
import { sideBySide } from './plot_canvas';
import type { PlotFile } from './plot_files';
import { saveMenu, timePlotsFile } from './plot_files';
import type { Group } from './plot_groups';
import { kByAlignment, kGroups, kNothingYet, kOptional, kUntimed } from './plot_groups';
import { PlotLegend } from './plot_legend';
import type { Context, View } from '../view';

const kRedraw_ms = 1000 / 15;
const kMostColumns = 3;
const kFew = 3;
/** Of a plot with axis, title and values. */
const kLeastWidth_px = 190;

/** Groups that are panels of their own as well. */
type PanelGroup = 'errors' | 'image';

const kGridLabel =
  'Plots over time: move with left and right, zoom with plus and minus, 0 shows the whole flight';

export class PlotsPanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly grid = h('div', { class: 'plot-grid', role: 'group' });
  private readonly whole = h(
    'button',
    {
      class: 'tab',
      'data-role': 'whole-flight',
      title:
        'Shows the whole flight in all plots (double click in a plot; 0 with the focus on them)',
      onclick: () => this.context.plotTime.showWhole(),
    },
    'Whole flight',
  );
  private readonly legend = new PlotLegend();
  private readonly statuses = new EstimatorTable();
  private readonly tabs = h('span', { class: 'tabs' });
  private readonly alignment = h('span', {
    class: 'alignment-note',
    'data-role': 'alignment',
    title: 'Alignment of the estimates to the truth (selected above the errors)',
  });
  private readonly scales = new AlignmentLegend();
  private readonly hoverTime = h('span', { class: 'hover-time' });
  private readonly files: HTMLSelectElement;
  private plots: Plot[] = [];
  private shownSpecs: readonly PlotSpec[] = [];
  private readonly paths: readonly PathPlot[];
  private drifts: DriftPlot[] = [];
  private key = '';
  /** Of the panel: asking for it in each frame causes a layout. */
  private width_px = 0;
  private drawn_ms = -Infinity;
  private timer = 0;
  /** Only a panel on the screen is updated. */
  private hidden = true;
  /** Time under the mouse. */
  private hovered_s: number | null = null;
  /** Time of the clock when it was drawn last. */
  private shown_s: number | null = null;

  /** @param only  shows only this group, as a panel of its own */
  constructor(
    private readonly context: Context,
    private readonly only: PanelGroup | null = null,
  ) {
    const name = only === null ? 'plots' : (`plots-${only}` as const);
    this.panel = makePanel(name, kPanels[name].title);
    this.paths = kPathAxes.map(
      (axes) => new PathPlot(axes, (t_s) => context.player.seekTime(t_s * 1e9)),
    );
    this.files = saveMenu(
      () => this.file(),
      (text) => context.notices.error(text),
    );
    if (only === null) this.panel.tools.append(this.tabs);
    this.panel.tools.append(this.whole, this.files, this.alignment, this.hoverTime);
    takeTimeKeys(this.grid, context.plotTime);
    this.panel.body.append(this.scales.root, this.grid, this.legend.root, this.statuses.root);
    this.root = this.panel.root;
    this.build();
    new ResizeObserver(() => {
      this.width_px = this.panel.body.clientWidth;
      this.drawSoon();
    }).observe(this.panel.body);
  }

  update(changed: ReadonlySet<Topic>): void {
    this.hidden = false;
    if (changed.has('run') || changed.has('rows') || changed.has('sensors')) this.drawSoon();
    if (changed.has('plots') || changed.has('metrics')) this.drawSoon();
    if (changed.has('run') || changed.has('estimators') || changed.has('log')) {
      this.drawTabs();
      if (this.group === 'estimators') this.statuses.draw(this.context.store.state);
    }
    if (changed.has('theme')) {
      for (const plot of [...this.plots, ...this.paths, ...this.drifts]) plot.repaint();
    }
    if (changed.has('playback')) this.context.plotTime.follow();
    // While it is moved, every frame counts.
    if (changed.has('plotTime')) this.draw();
    if (changed.has('playback') || changed.has('run')) this.moveCursor();
  }

  onHidden(): void {
    this.hidden = true;
    window.clearTimeout(this.timer);
    this.timer = 0;
    this.hideSensors();
  }

  private hideSensors(): void {
    if (this.only === null) this.context.sensors.hide();
  }

  private get group(): Group {
    const { plotGroup } = this.context.store.state;
    return this.only ?? kGroups.find(({ name }) => name === plotGroup)?.name ?? kGroups[0].name;
  }

  private drawSoon(): void {
    if (this.hidden || this.timer !== 0) return;
    const wait_ms = Math.max(0, this.drawn_ms + kRedraw_ms - performance.now());
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      this.drawn_ms = performance.now();
      this.draw();
    }, wait_ms);
  }

  private draw(): void {
    const { state } = this.context.store;
    if (this.group === 'sensors' && state.runId !== null) {
      this.context.sensors.show(state.runId, this.context.plotTime.partOfRun_s);
    } else {
      this.hideSensors();
    }
    if (this.key !== this.wantedKey()) this.build();
    this.drawTabs();
    this.scales.draw(state, kByAlignment.includes(this.group));
    const { part_s, shown_s } = this.context.plotTime;
    this.whole.hidden = part_s === null || this.plots.length === 0;
    for (const plot of this.plots) plot.draw(shown_s);
    this.legend.show(this.shownSpecs);
    if (this.group === 'path') for (const path of this.paths) path.draw(state);
    if (this.group === 'drift') this.drawDrifts(driftSpecs(state));
    this.panel.showEmpty(this.emptyText());
    this.moveCursor();
  }

  /** The two plots stay as long as there are figures. */
  private drawDrifts(specs: readonly DriftSpec[]): void {
    if (this.drifts.length !== specs.length) {
      this.drifts = specs.map((spec) => new DriftPlot(spec));
      this.grid.replaceChildren(...this.drifts.map(({ root }) => root));
    }
    specs.forEach((spec, i) => this.drifts[i]?.draw(spec));
    this.legend.show(specs);
    this.panel.body.classList.toggle('has-legend', !this.legend.root.hidden);
  }

  private emptyText(): string | null {
    const { runId, sensors, sensorError } = this.context.store.state;
    if (runId === null) return 'Poses of the flight appear here.';
    const { group } = this;
    if (this.plots.length + this.drifts.length > 0 || group === 'estimators' || group === 'path')
      return null;
    if (group !== 'sensors') return kNothingYet[group];
    if (sensorError !== null) return sensorError;
    return sensors === null
      ? 'Reading the samples'
      : 'This aircraft has no sensors except its cameras.';
  }

  /** Unchanged as long as the plots need not be rebuilt. */
  private wantedKey(): string {
    const { state } = this.context.store;
    const runs = state.watched.map((watched) => [
      watched.id,
      watched.data.generation,
      shownAlignment(watched),
    ]);
    const specs = this.specs();
    const columns = this.columns(specs.length);
    return JSON.stringify([this.group, runs, columns, specs.map(specKey)]);
  }

  private file(): PlotFile | null {
    const { group } = this;
    if (group === 'path') {
      return {
        name: group,
        csv: () => tracksCsv(this.context.store.state),
        svg: () => sideBySide(this.paths.map((path) => path.drawing())),
      };
    }
    if (group === 'drift') {
      const drifts = driftSpecs(this.context.store.state);
      return {
        name: group,
        csv: () => driftCsv(drifts),
        svg: () => sideBySide(this.drifts.map((drift) => drift.drawing())),
      };
    }
    const specs = this.specs();
    if (specs.length === 0) return null;
    const { shown_s: span_s } = this.context.plotTime;
    return timePlotsFile({ group, specs, span_s, columns: this.columns(specs.length) });
  }

  /** As many as fit; few plots lie below each other. */
  private columns(plots: number): number {
    const fitting = Math.floor(this.width_px / kLeastWidth_px);
    return plots <= kFew ? 1 : Math.min(kMostColumns, Math.max(1, fitting));
  }

  private specs(): PlotSpec[] {
    const { group } = this;
    if (group === 'estimators' || group === 'path' || group === 'drift') return [];
    return plotSpecs(this.context.store.state, group);
  }

  private build(): void {
    const { plotTime, store } = this.context;
    const { state } = store;
    this.key = this.wantedKey();
    for (const plot of this.plots) plot.destroy();
    // The mouse does not leave a plot that is removed.
    this.hovered_s = null;
    const actions: PlotActions = {
      onSeek: (t_s: number) => this.context.player.seekTime(t_s * 1e9),
      onHover: (t_s: number | null) => this.hover(t_s),
      onZoom: (centre_s, factor) => plotTime.zoom(centre_s, factor),
      onPan: (by_s) => plotTime.pan(by_s),
      onWhole: () => plotTime.showWhole(),
    };
    const specs = this.specs();
    this.shownSpecs = specs;
    this.legend.show(specs);
    this.panel.body.classList.toggle('has-legend', !this.legend.root.hidden);
    const columns = this.columns(specs.length);
    this.files.hidden =
      this.group === 'estimators' || (specs.length === 0 && !kUntimed.includes(this.group));
    this.plots = specs.map(
      (spec, i) =>
        new Plot(spec, actions, { timeLabels: i >= specs.length - columns, leads: i === 0 }),
    );
    const down = Math.ceil(specs.length / columns);
    this.grid.style.gridTemplateColumns = `repeat(${columns}, minmax(0, 1fr))`;
    this.grid.style.gridTemplateRows = `repeat(${down}, minmax(min-content, 1fr))`;
    if (kUntimed.includes(this.group)) this.grid.removeAttribute('style');
    const overTime = specs.length > 0;
    setAttribute(this.grid, 'tabindex', overTime ? '0' : null);
    setAttribute(this.grid, 'aria-label', overTime ? kGridLabel : null);
    this.grid.hidden = this.group === 'estimators';
    this.statuses.root.hidden = this.group !== 'estimators';
    if (this.group === 'estimators') this.statuses.draw(state);
    setAttribute(this.grid, 'data-group', this.group);
    this.drifts = [];
    const drawn = this.group === 'path' ? this.paths : this.plots;
    this.grid.replaceChildren(...drawn.map(({ root }) => root));
    setText(this.alignment, this.alignmentText());
    this.drawTabs();
  }

  private alignmentText(): string {
    const aligned = this.context.store.state.watched.filter(
      ({ run }) => (run?.estimators.length ?? 0) > 0,
    );
    if (!kByAlignment.includes(this.group) || aligned.length === 0) return '';
    return `estimates by ${[...new Set(aligned.map(shownAlignment))].join(', ')}`;
  }

  private drawTabs(): void {
    const { watched } = this.context.store.state;
    const attention = watched.some(({ statuses }) => needsAttention(statuses));
    const groups = kGroups.filter(
      ({ name }) =>
        !kOptional.some((group) => group === name) ||
        watched.some(({ series }) => series.some((one) => groupOf(one) === name)),
    );
    const names = groups.map(({ name }) => name).join(' ');
    rebuild(this.tabs, `${names} ${this.group} ${attention}`, () =>
      groups.map(({ name, label, hint }) =>
        h(
          'button',
          {
            class: 'tab',
            title: hint,
            'data-group': name,
            'aria-pressed': name === this.group ? 'true' : 'false',
            'data-attention': attention && name === 'estimators',
            onclick: () => {
              this.context.store.state.plotGroup = name;
              this.context.store.change('plots');
            },
          },
          label,
        ),
      ),
    );
  }

  private moveCursor(): void {
    const { playback } = this.context.store.state;
    const cursor_s = this.cursor_s();
    // A mouse that rests while the clock is moved does not keep values of another instant.
    if (playback?.playing === false && cursor_s !== this.shown_s) this.hover(null);
    this.shown_s = cursor_s;
    for (const plot of this.plots) plot.moveCursor(cursor_s);
    if (this.group === 'path') {
      for (const path of this.paths) path.moveMarks(this.context.store.state);
    }
    this.panel.showFrame(frameOf(playback));
    this.showValues();
  }

  private cursor_s(): number | null {
    const { clock } = this.context.store.state;
    return clock === null ? null : clock.t_ns / 1e9;
  }

  private showCursorValues(): void {
    const { state } = this.context.store;
    // During the flight the cursor is ahead of the samples that were read.
    const live = this.group === 'sensors' && state.clock?.live === true;
    const newest_s = (state.sensors?.newest_s ?? Infinity) + state.offset_ns / 1e9;
    const t_s = this.cursor_s();
    for (const plot of this.plots) {
      plot.showCursor(live && t_s !== null ? Math.min(t_s, newest_s) : t_s);
    }
  }

  /** Shows values under the mouse in place of those at the cursor. */
  private hover(t_s: number | null): void {
    this.hovered_s = t_s === null ? null : this.readAt_s(t_s);
    setText(this.hoverTime, this.hovered_s === null ? '' : formatTime(this.hovered_s * 1e9));
    this.showValues();
  }

  /** Of frames the one to which a click seeks: the values do not change by it. */
  private readAt_s(t_s: number): number {
    const ownTimes: readonly Group[] = ['sensors', 'vehicle'];
    if (ownTimes.includes(this.group)) return t_s;
    return this.context.player.seekTarget_ns(t_s * 1e9) / 1e9;
  }

  private showValues(): void {
    const { hovered_s } = this;
    if (hovered_s === null || hovered_s === this.cursor_s()) this.showCursorValues();
    else for (const plot of this.plots) plot.showHover(hovered_s);
  }
}

function specKey({ key, curves, lanes }: PlotSpec) {
  return [key, curves.map(({ name, hue }) => [name, hue]), lanes?.length];
}
