// Tracks seen from above or from the side, with equal scales in metres. The wheel zooms, dragging
// moves, a double click shows everything again, a click seeks.
import type { Axis } from '../../store/run_data';
import type { Path, PathFrame, PathMark, Size } from '../../store/plots/path_frame';
import {
  boxOf,
  fitted,
  ticks,
  tickText,
  toMetres,
  toPixels,
  zoomedAt,
} from '../../store/plots/path_frame';
import type { Pen } from '../../store/plots/svg_pen';
import type { State } from '../../store/state';
import { hueOf } from '../../store/plots/plot_specs';
import type { SharedExtent } from '../../store/plots/shared_extent';
import { legendNames } from '../../store/plots/shared_extent';
import { drawnTracks, tableOf, tracksOf } from '../../store/tracks';
import { curveStyle } from '../colours';
import { h, setText } from '../dom';
import { paint } from '../paint';
import { BeyondNote } from './beyond_note';
import type { Drawing } from './plot_canvas';
import { PlotCanvas } from './plot_canvas';

const kZoom_per_px = 0.0015;
const kTickSpace_px = 70;
/** Points nearer than this to the last one are not drawn. */
const kLeastStep_px = 0.7;
const kClick_px = 4;
/** A click farther from every track does not seek. */
const kNear_px = 30;

export interface PathAxes {
  key: string;
  label: string;
  hint: string;
  across: Axis;
  up: Axis;
}

export const kPathAxes: readonly PathAxes[] = [
  { key: 'xy', label: 'From above', hint: 'x east, y north', across: 'x_m', up: 'y_m' },
  { key: 'xz', label: 'From the south', hint: 'x east, z up', across: 'x_m', up: 'z_m' },
];

export class PathPlot {
  readonly root: HTMLElement;
  private readonly plot = new PlotCanvas((pen, size) => this.paintAll(pen, size), {
    width_px: 20,
    height_px: 20,
  });
  private readonly readout = h('span', { class: 'readout' });
  private readonly beyond = new BeyondNote();
  private paths: readonly Path[] = [];
  private box: SharedExtent | null = null;
  private marks: readonly PathMark[] = [];
  /** null = everything. */
  private chosen: PathFrame | null = null;
  /** What the tracks belong to. */
  private subject = '';

  /** @param onSeek  to a time of the clock [s] */
  constructor(
    private readonly axes: PathAxes,
    private readonly onSeek: (t_s: number) => void,
  ) {
    const { key, label, hint } = axes;
    this.plot.area.append(this.beyond.root);
    this.plot.canvas.setAttribute('aria-label', `Tracks ${label.toLowerCase()}`);
    this.root = h(
      'div',
      { class: 'plot path-plot', 'data-axis': key },
      h(
        'div',
        { class: 'plot-title', title: `${hint}; double click: everything` },
        h('b', {}, label),
        h('span', { class: 'unit' }, `${hint} [m]`),
        this.readout,
      ),
      this.plot.area,
    );
    this.steer();
  }

  /** Takes the tracks as they are now. */
  draw(state: State): void {
    const paths = drawnTracks(state).flatMap((track): Path[] => {
      const { run, label: name } = track;
      const table = tableOf(track);
      if (table === undefined) return [];
      const { across, up } = this.axes;
      const [x, y, t] = [table.column(across), table.column(up), table.column('t_ns')];
      return [{ name, hue: hueOf(track), x, y, t, t_scale_s: 1e-9, t_offset_s: run.offset_s }];
    });
    this.setSubject(state.watched.map(({ id }) => id).join(' '));
    this.show(paths, this.marksOf(state));
  }

  moveMarks(state: State): void {
    this.show(this.paths, this.marksOf(state));
  }

  /** Of other runs, or with another truth, everything is shown first. */
  setSubject(subject: string): void {
    if (subject !== this.subject) this.chosen = null;
    this.subject = subject;
  }

  show(paths: readonly Path[], marks: readonly PathMark[]): void {
    if (paths !== this.paths) {
      this.paths = paths;
      this.box = boxOf(paths);
      this.beyond.show(paths.filter((_, i) => this.box?.beyond.includes(i)));
    }
    this.marks = marks;
    this.repaint();
  }

  private marksOf(state: State): PathMark[] {
    const { across, up } = this.axes;
    return tracksOf(state).flatMap((track) => {
      const { run, name, shown } = track;
      const pose = name === '' ? run.instant?.truth : run.instant?.estimates[name]?.pose;
      if (!shown || pose === undefined || pose === null) return [];
      return { x: pose[across], y: pose[up], hue: hueOf(track) };
    });
  }

  repaint(): void {
    this.plot.repaint();
  }

  private frame(): PathFrame {
    return this.chosen ?? fitted(this.box, this.plot.size());
  }

  /** As it is shown, drawn into a file: its title, names and tracks. */
  drawing(): Drawing {
    const { label, hint } = this.axes;
    const names = legendNames(this.paths, this.box?.beyond ?? []);
    return this.plot.drawing(8, `${label}: ${hint} [m]`, names);
  }

  private paintAll(pen: Pen, size: Size): void {
    const frame = this.frame();
    this.paintGrid(pen, frame, size);
    for (const path of this.paths) paintPath(pen, path, frame, size);
    for (const { x, y, hue } of this.marks) {
      const [px, py] = toPixels(frame, size, [x, y]);
      pen.fillStyle = paint(curveStyle(hue).colour);
      pen.beginPath();
      pen.arc(px, py, hue.kind === 'truth' ? 5 : 3.5, 0, 2 * Math.PI);
      pen.fill();
    }
  }

  private paintGrid(pen: Pen, frame: PathFrame, size: Size): void {
    const [left, bottom] = toMetres(frame, size, [0, size.height_px]);
    const [right, top] = toMetres(frame, size, [size.width_px, 0]);
    pen.strokeStyle = paint('var(--grid)');
    pen.fillStyle = paint('var(--muted)');
    pen.font = '10px system-ui, sans-serif';
    pen.lineWidth = 1;
    const columns = ticks(left, right, size.width_px / kTickSpace_px);
    const rows = ticks(bottom, top, size.height_px / kTickSpace_px);
    pen.beginPath();
    for (const x of columns) {
      const [px] = toPixels(frame, size, [x, 0]);
      pen.moveTo(px, 0);
      pen.lineTo(px, size.height_px);
    }
    for (const y of rows) {
      const [, py] = toPixels(frame, size, [0, y]);
      pen.moveTo(0, py);
      pen.lineTo(size.width_px, py);
    }
    pen.stroke();
    const step = (list: number[]) => (list[1] ?? 1) - (list[0] ?? 0);
    pen.textAlign = 'center';
    for (const x of columns) {
      const [px] = toPixels(frame, size, [x, 0]);
      if (px > 30 && px < size.width_px - 16) {
        pen.fillText(tickText(x, step(columns)), px, size.height_px - 4);
      }
    }
    pen.textAlign = 'left';
    for (const y of rows) {
      const [, py] = toPixels(frame, size, [0, y]);
      if (py > 12 && py < size.height_px - 16) pen.fillText(tickText(y, step(rows)), 3, py - 3);
    }
  }

  private steer(): void {
    const { area } = this.plot;
    /** By the pointer that moves the plot; others do not. */
    let grabbed: { id: number; at: [number, number]; moved: boolean } | null = null;
    const at = (event: MouseEvent): [number, number] => {
      const box = area.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    area.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      if (grabbed !== null && area.hasPointerCapture(grabbed.id)) return;
      grabbed = { id: event.pointerId, at: at(event), moved: false };
      area.setPointerCapture(event.pointerId);
    });
    area.addEventListener('pointermove', (event) => {
      const here = at(event);
      const [x, y] = toMetres(this.frame(), this.plot.size(), here);
      setText(this.readout, `${tickText(x, 0.1)} ${tickText(y, 0.1)}`);
      if (grabbed?.id !== event.pointerId) return;
      const [dx, dy] = [here[0] - grabbed.at[0], here[1] - grabbed.at[1]];
      if (!grabbed.moved && Math.hypot(dx, dy) < kClick_px) return;
      const { centre_m, m_per_px } = this.frame();
      this.chosen = {
        centre_m: [centre_m[0] - dx * m_per_px, centre_m[1] + dy * m_per_px],
        m_per_px,
      };
      grabbed = { id: event.pointerId, at: here, moved: true };
      this.repaint();
    });
    area.addEventListener('pointerup', (event) => {
      if (grabbed?.id !== event.pointerId) return;
      if (!grabbed.moved) this.seekNear(at(event));
      grabbed = null;
    });
    area.addEventListener('pointercancel', ({ pointerId }) => {
      if (grabbed?.id === pointerId) grabbed = null;
    });
    area.addEventListener('pointerleave', () => setText(this.readout, ''));
    area.addEventListener('dblclick', () => {
      this.chosen = null;
      this.repaint();
    });
    area.addEventListener(
      'wheel',
      (event) => {
        event.preventDefault();
        const factor = Math.exp(event.deltaY * kZoom_per_px);
        this.chosen = zoomedAt(this.frame(), this.plot.size(), at(event), factor);
        this.repaint();
      },
      { passive: false },
    );
  }

  /** Seeks to the time at which a track is nearest to a point of the plot. */
  private seekNear(point: [number, number]): void {
    const frame = this.frame();
    const size = this.plot.size();
    let least_px = kNear_px;
    let found: { path: Path; row: number } | null = null;
    for (const path of this.paths) {
      for (let row = 0; row < path.x.length; row += 1) {
        const [x, y] = toPixels(frame, size, [path.x[row] ?? NaN, path.y[row] ?? NaN]);
        const off_px = Math.hypot(x - point[0], y - point[1]);
        if (!(off_px < least_px)) continue;
        least_px = off_px;
        found = { path, row };
      }
    }
    if (found === null) return;
    const { path, row } = found;
    this.onSeek((path.t[row] ?? 0) * path.t_scale_s + path.t_offset_s);
  }
}

function paintPath(pen: Pen, { hue, x, y }: Path, frame: PathFrame, size: Size): void {
  const { colour, width_px, dash } = curveStyle(hue);
  pen.strokeStyle = paint(colour);
  pen.lineWidth = width_px;
  pen.setLineDash(dash);
  pen.beginPath();
  let last: [number, number] | null = null;
  for (let i = 0; i < x.length; i += 1) {
    const point = toPixels(frame, size, [x[i] ?? NaN, y[i] ?? NaN]);
    if (Number.isNaN(point[0]) || Number.isNaN(point[1])) {
      last = null;
      continue;
    }
    if (last === null) pen.moveTo(...point);
    else if (Math.hypot(point[0] - last[0], point[1] - last[1]) < kLeastStep_px) continue;
    else pen.lineTo(...point);
    last = point;
  }
  pen.stroke();
  pen.setLineDash([]);
}
