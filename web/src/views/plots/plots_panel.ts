// Plots over time, drawn at most 15 times a second: the pose, the camera's image or the sensors; or
// instead the status of the estimators.
import { needsAttention } from '../../store/estimator_status';
import { formatTime } from '../../store/format';
import { lastAtOrBefore, nearestIndex } from '../../store/table';
import type { Span } from '../../store/time_window';
import { following, zoomed } from '../../store/time_window';
import { plannedEnd_ns, shownAlignment } from '../../store/state';
import type { Topic } from '../../store/state';
import { EstimatorTable } from '../estimator_table';
import { h, rebuild, setAttribute, setText } from '../dom';
import type { Panel } from '../panel';
import { frameOf, makePanel } from '../panel';
import type { PlotActions, Strip } from './plot_strips';
import { imageStrips, poseStrips } from './plot_strips';
import { sensorStrips, shownFigures } from './sensor_strips';
import type { Context, View } from '../view';

const kRedraw_ms = 1000 / 15;

const kGroups = [
  { name: 'pose', label: 'Pose', hint: 'Position and attitude: truth and estimates' },
  { name: 'image', label: 'Image', hint: 'Texels per pixel, exposure and saturation' },
  { name: 'sensors', label: 'Sensors', hint: 'IMU, GPS, air data, magnetometer, rangefinder' },
  { name: 'estimators', label: 'Estimators', hint: 'State, drops, latency, CPU, memory, log' },
] as const;
type Group = (typeof kGroups)[number]['name'];

export class PlotsPanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly grid = h('div', { class: 'plot-grid' });
  private readonly statuses = new EstimatorTable();
  private readonly tabs = h('span', { class: 'tabs' });
  private readonly alignment = h('span', {
    class: 'alignment-note',
    'data-role': 'alignment',
    title: 'Alignment of the estimates to the truth (selected above the errors)',
  });
  private readonly hoverTime = h('span', { class: 'hover-time' });
  private group: Group = 'pose';
  private strips: Strip[] = [];
  private key = '';
  private t_s = new Float64Array(0);
  private drawn_ms = -Infinity;
  private timer = 0;
  /** Time under the mouse. */
  private hovered_s: number | null = null;
  /** The part zoomed to; null = the whole flight. */
  private window_s: Span | null = null;

  constructor(private readonly context: Context) {
    this.panel = makePanel('plots', 'Over time [s]', true);
    this.panel.tools.append(this.tabs, this.alignment, this.hoverTime);
    this.panel.body.append(this.grid, this.statuses.root);
    this.root = this.panel.root;
    this.build();
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('run') || changed.has('rows') || changed.has('sensors')) this.drawSoon();
    if (changed.has('run') || changed.has('estimators') || changed.has('log')) {
      this.drawTabs();
      if (this.group === 'estimators') this.statuses.draw(this.context.store.state);
    }
    if (changed.has('playback')) this.followCursor();
    if (changed.has('playback') || changed.has('run')) this.moveCursor();
  }

  private drawSoon(): void {
    if (this.timer !== 0) return;
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
      this.context.sensors.show(state.runId, this.window_s);
    } else {
      this.context.sensors.hide();
    }
    if (this.key !== this.wantedKey()) this.build();
    const t_ns = state.data.truth.column('t_ns');
    if (this.t_s.length !== t_ns.length) this.t_s = t_ns.map((t) => t / 1e9);
    const span_s = this.window_s ?? this.whole();
    for (const strip of this.strips) strip.draw(state, this.t_s, span_s);
    this.panel.showEmpty(this.emptyText());
    this.moveCursor();
  }

  private emptyText(): string | null {
    const { runId, sensors, sensorError } = this.context.store.state;
    if (runId === null) return 'Poses of the flight appear here.';
    if (this.group !== 'sensors') return null;
    if (sensorError !== null) return sensorError;
    if (sensors === null) return 'Reading the samples';
    return this.strips.length === 0 ? 'This aircraft has no sensors except its cameras.' : null;
  }

  private whole(): Span {
    const planned_s = plannedEnd_ns(this.context.store.state) / 1e9;
    return [0, Math.max(planned_s, this.t_s.at(-1) ?? 0, 1)];
  }

  private zoom(centre_s: number, factor: number): void {
    const whole = this.whole();
    this.window_s = factor === 0 ? null : zoomed(this.window_s ?? whole, whole, centre_s, factor);
    this.drawSoon();
  }

  /** Keeps the cursor inside the window. */
  private followCursor(): void {
    const { playback } = this.context.store.state;
    if (this.window_s === null || playback === null) return;
    const moved = following(this.window_s, this.whole(), playback.t_ns / 1e9);
    if (moved === this.window_s) return;
    this.window_s = moved;
    this.drawSoon();
  }

  /** Unchanged as long as the plots need not be rebuilt. */
  private wantedKey(): string {
    const { state } = this.context.store;
    const names = state.run?.estimators ?? [];
    const figures = this.group === 'sensors' ? shownFigures(state).map(({ key }) => key) : [];
    const parts = [
      String(state.runId),
      state.data.generation,
      this.group,
      shownAlignment(state),
      ...figures,
    ];
    return [...parts, ...names].join('/');
  }

  private build(): void {
    const { state } = this.context.store;
    const names = state.run?.estimators ?? [];
    const [run] = this.key.split('/', 1);
    if (run !== String(state.runId)) this.window_s = null;
    this.key = this.wantedKey();
    for (const { plot } of this.strips) plot.destroy();
    const actions: PlotActions = {
      onSeek: (t_s: number) => this.context.player.seekTime(t_s * 1e9),
      onHover: (t_s: number | null) => this.hover(t_s),
      onZoom: (centre_s: number, factor: number) => this.zoom(centre_s, factor),
    };
    this.strips = this.makeStrips(names, actions);
    this.grid.hidden = this.group === 'estimators';
    this.statuses.root.hidden = this.group !== 'estimators';
    if (this.group === 'estimators') this.statuses.draw(state);
    setAttribute(this.grid, 'data-group', this.group);
    this.grid.replaceChildren(...this.strips.map(({ plot }) => plot.root));
    const drawn = this.group === 'pose' && names.length > 0;
    setText(this.alignment, drawn ? `estimates by ${shownAlignment(state)}` : '');
    this.drawTabs();
  }

  private makeStrips(names: readonly string[], actions: PlotActions): Strip[] {
    if (this.group === 'pose') return poseStrips(names, actions);
    if (this.group === 'sensors') return sensorStrips(this.context.store.state, actions);
    return this.group === 'image' ? imageStrips(actions) : [];
  }

  private drawTabs(): void {
    const attention = needsAttention(this.context.store.state.statuses);
    rebuild(this.tabs, `${this.group} ${attention}`, () =>
      kGroups.map(({ name, label, hint }) =>
        h(
          'button',
          {
            class: 'tab',
            title: hint,
            'data-group': name,
            'aria-pressed': name === this.group ? 'true' : 'false',
            'data-attention': attention && name === 'estimators',
            onclick: () => {
              this.group = name;
              this.draw();
            },
          },
          label,
        ),
      ),
    );
  }

  private moveCursor(): void {
    const { playback } = this.context.store.state;
    const t_s = playback === null ? null : playback.t_ns / 1e9;
    for (const { plot } of this.strips) plot.moveCursor(t_s);
    this.panel.showFrame(frameOf(playback));
    if (this.hovered_s === null) this.showCursorValues();
  }

  private showCursorValues(): void {
    const { state } = this.context.store;
    const row = lastAtOrBefore(
      state.data.truth.column('frame'),
      state.playback === null ? -1 : state.playback.frame,
    );
    for (const strip of this.strips) strip.showCursor(state, row);
  }

  /** Shows values under the mouse in place of those at the cursor. */
  private hover(t_s: number | null): void {
    this.hovered_s = t_s;
    if (t_s === null) {
      setText(this.hoverTime, '');
      this.showCursorValues();
      return;
    }
    const { state } = this.context.store;
    const { truth } = state.data;
    const row = nearestIndex(truth.column('t_ns'), t_s * 1e9);
    const byFrame = this.group !== 'sensors' && row >= 0;
    setText(this.hoverTime, formatTime(byFrame ? truth.at('t_ns', row) : t_s * 1e9));
    for (const strip of this.strips) strip.showHover(state, t_s, row);
  }
}
