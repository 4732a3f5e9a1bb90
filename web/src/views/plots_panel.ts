// Six plots of the pose over time, drawn at most 15 times a second.
import { formatTime, wrapDegrees } from '../store/format';
import type { Axis } from '../store/run_data';
import { kAxes } from '../store/run_data';
import type { Span } from '../store/time_window';
import { following, zoomed } from '../store/time_window';
import { EstimateCurve, isAngle, TruthCurve } from '../store/series';
import type { Topic } from '../store/state';
import { h, setText } from './dom';
import type { Panel } from './panel';
import { frameOf, makePanel } from './panel';
import { Plot } from './plot';
import type { Context, View } from './view';

const kRedraw_ms = 1000 / 15;

const kLabels: Record<Axis, string> = {
  x_m: 'x east',
  y_m: 'y north',
  z_m: 'z up',
  roll_deg: 'Roll',
  pitch_deg: 'Pitch',
  yaw_deg: 'Yaw',
};

interface AxisPlot {
  axis: Axis;
  plot: Plot;
  truth: TruthCurve;
  estimates: EstimateCurve[];
}

export class PlotsPanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly grid = h('div', { class: 'plot-grid' });
  private readonly hoverTime = h('span', { class: 'hover-time' });
  private plots: AxisPlot[] = [];
  private key = '';
  private t_s = new Float64Array(0);
  private drawn_ms = -Infinity;
  private timer = 0;
  private hovered: number | null = null;
  /** What the viewer zoomed to; null = the whole flight. */
  private window_s: Span | null = null;

  constructor(private readonly context: Context) {
    this.panel = makePanel('plots', 'Pose over time [s]', true);
    this.panel.tools.append(this.hoverTime);
    this.panel.body.append(this.grid);
    this.root = this.panel.root;
    this.build();
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('run') || changed.has('rows')) this.drawSoon();
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
    const { run, runId, data } = this.context.store.state;
    const names = run?.estimators ?? [];
    if (this.key !== `${String(runId)}/${data.generation}/${names.join('/')}`) this.build();
    const t_ns = data.truth.column('t_ns');
    if (this.t_s.length !== t_ns.length) this.t_s = t_ns.map((t) => t / 1e9);
    const span_s = this.window_s ?? this.whole();
    for (const { plot, truth, estimates } of this.plots) {
      const curve = truth.update(data);
      const others = names.map((name, i) => {
        const rows = data.estimates.get(name);
        return rows === undefined ? [] : (estimates[i]?.update(data, rows, curve) ?? []);
      });
      plot.setData(this.t_s, curve, others, span_s);
    }
    this.panel.showEmpty(runId === null ? 'Poses of the flight appear here.' : null);
    this.moveCursor();
  }

  private whole(): Span {
    const { run } = this.context.store.state;
    return [0, Math.max((run?.duration_ns ?? 0) / 1e9, this.t_s.at(-1) ?? 0, 1)];
  }

  private zoom(centre_s: number, factor: number): void {
    const whole = this.whole();
    this.window_s = factor === 0 ? null : zoomed(this.window_s ?? whole, whole, centre_s, factor);
    this.drawSoon();
  }

  /** Keeps the cursor in the window when it moves. */
  private followCursor(): void {
    const { playback } = this.context.store.state;
    if (this.window_s === null || playback === null) return;
    const moved = following(this.window_s, this.whole(), playback.t_ns / 1e9);
    if (moved === this.window_s) return;
    this.window_s = moved;
    this.drawSoon();
  }

  private build(): void {
    const { run, runId, data } = this.context.store.state;
    const names = run?.estimators ?? [];
    this.key = `${String(runId)}/${data.generation}/${names.join('/')}`;
    this.window_s = null;
    for (const { plot } of this.plots) plot.destroy();
    this.plots = kAxes.map((axis, index) => ({
      axis,
      truth: new TruthCurve(axis),
      estimates: names.map(() => new EstimateCurve(axis)),
      plot: new Plot({
        axis,
        label: kLabels[axis],
        unit: isAngle(axis) ? 'deg' : 'm',
        timeLabels: index >= 3,
        estimators: names.length,
        onSeek: (t_s) => this.context.player.seekTime(t_s * 1e9),
        onHover: (row) => this.hover(row),
        onZoom: (centre_s, factor) => this.zoom(centre_s, factor),
      }),
    }));
    this.grid.replaceChildren(...this.plots.map(({ plot }) => plot.root));
  }

  private moveCursor(): void {
    const { playback } = this.context.store.state;
    for (const { plot } of this.plots)
      plot.moveCursor(playback === null ? null : playback.t_ns / 1e9);
    this.panel.showFrame(frameOf(playback));
    if (this.hovered === null) this.showPlaybackValues();
  }

  private showPlaybackValues(): void {
    const { playback, run } = this.context.store.state;
    for (const { axis, plot } of this.plots) {
      const poses = [
        playback?.truth,
        ...(run?.estimators ?? []).map((name) => playback?.estimates[name]?.pose),
      ];
      plot.showValues(poses.map((pose) => pose?.[axis]));
    }
  }

  /** Values under the mouse in place of those at the cursor. */
  private hover(row: number | null): void {
    this.hovered = row;
    const { data, run } = this.context.store.state;
    setText(this.hoverTime, row === null ? '' : formatTime(data.truth.at('t_ns', row)));
    if (row === null) {
      this.showPlaybackValues();
      return;
    }
    for (const { axis, plot, estimates, truth } of this.plots) {
      const curve = truth.update(data);
      const others = (run?.estimators ?? []).map((name, i) => {
        const rows = data.estimates.get(name);
        return rows === undefined ? null : estimates[i]?.update(data, rows, curve)[row];
      });
      const values = [data.truth.at(axis, row), ...others];
      plot.showValues(
        values.map((value) =>
          isAngle(axis) && typeof value === 'number' ? wrapDegrees(value) : value,
        ),
      );
    }
  }
}
