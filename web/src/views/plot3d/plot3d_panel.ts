// The 3D plot: truth and estimates of all watched runs, drawn by the browser. The server's 3D view
// (views/scene) shows the ground as well; this one shows axes and needs no pictures.
import { kPanels } from '../../store/layouts/panel_names';
import { bodyAxes } from '../../store/plot3d/attitude';
import { boxOfAll } from '../../store/plot3d/axis_box';
import type { Size } from '../../store/plots/path_frame';
import { tracksCsv } from '../../store/plots/track_files';
import type { State, Topic } from '../../store/state';
import { shownAlignment } from '../../store/state';
import { tracksOf } from '../../store/tracks';
import { legendEntries, legendLine } from '../alignment_legend';
import { trackColour } from '../colours';
import { h, perFrame, rebuild, setAttribute } from '../dom';
import { paint } from '../paint';
import type { Panel } from '../panel';
import { frameOf, makePanel } from '../panel';
import type { PlotFile } from '../plots/plot_files';
import { saveMenu } from '../plots/plot_files';
import type { Context, View } from '../view';
import { paintAxes } from './axes_painter';
import { LineStage } from './line_stage';
import type { Mark } from './marks_painter';
import { paintMarks } from './marks_painter';
import { plot3dSvg } from './plot3d_file';
import type { Pixel } from './plot3d_steering';
import { steerPlot } from './plot3d_steering';
import { plot3dTools } from './plot3d_tools';
import { Plot3dView } from './plot3d_view';
import { HoverNote } from './hover_note';
import { hueOf } from '../../store/plots/plot_specs';
import { BeyondNote } from '../plots/beyond_note';
import { rgbOf } from './rgb';
import { ShownTracks } from './shown_tracks';

const kHoverNear_px = 14;
/** A click farther from every track does not seek. */
const kClickNear_px = 30;
const kNoWebGl =
  'The 3D plot needs WebGL 2, which this browser does not offer. “Path” of “Over time” shows the ' +
  'tracks from above and from the side.';
const kLost =
  'The browser has taken the graphics memory back. The plot returns when the browser gives it ' +
  'again; if it does not, reload the page.';

export class Plot3dPanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly grid = h('canvas', { 'aria-hidden': 'true' });
  private readonly lines = h('canvas', { 'aria-hidden': 'true', 'data-role': 'plot3d-lines' });
  private readonly marks = h('canvas', { 'aria-hidden': 'true' });
  private readonly legend = h('div', { class: 'legend' });
  private readonly note = new HoverNote();
  private readonly beyond = new BeyondNote();
  private readonly area = h('div', { class: 'plot3d-area', tabindex: 0, role: 'img' });
  private readonly stage: LineStage | null;
  private readonly tracks: ShownTracks | null;
  private readonly view = new Plot3dView({ min: [0, 0, 0], max: [0, 0, 0] }, () => this.redraw());
  private errorLines = true;
  private lost = false;
  private runs = '';
  private draws = 0;
  private readonly redrawInFrame = perFrame<null>(() => this.draw());

  constructor(private readonly context: Context) {
    this.panel = makePanel('plot3d', kPanels.plot3d.title);
    this.root = this.panel.root;
    this.stage = LineStage.open(this.lines);
    this.tracks = this.stage === null ? null : new ShownTracks(this.stage);
    this.area.append(this.grid, this.lines, this.marks, this.legend, ...this.note.parts);
    this.area.append(this.beyond.root);
    this.panel.body.prepend(this.area);
    this.panel.tools.append(
      saveMenu(
        () => this.file(),
        (text) => context.notices.error(text),
      ),
      ...plot3dTools({
        fit: (direction) => this.view.fit(direction),
        exaggerate: (heightScale) => this.view.exaggerate(heightScale),
        showErrors: (on) => {
          this.errorLines = on;
          this.redraw();
        },
      }),
    );
    this.steer();
    this.followContext();
    new ResizeObserver(() => {
      this.view.setSize(this.size());
      this.redraw();
    }).observe(this.area);
  }

  update(changed: ReadonlySet<Topic>): void {
    const { state } = this.context.store;
    if (changed.has('run') || changed.has('rows') || changed.has('theme')) this.takeTracks(state);
    else if (!changed.has('playback')) return;
    this.panel.showFrame(frameOf(state.playback));
    this.redraw();
  }

  onHidden(): void {
    this.note.hide();
  }

  private takeTracks(state: State): void {
    const runs = state.watched.map(({ id }) => id).join(' ');
    if (runs !== this.runs) this.view.fit();
    this.runs = runs;
    this.tracks?.take(state);
    const shown = this.tracks?.all ?? [];
    const all = boxOfAll(
      shown.map(({ track, points }) => ({ box: points.box, estimate: track.name !== '' })),
    );
    if (all !== null && this.view.setBox(all.box)) this.note.hide();
    const beyond = shown.filter((_, i) => all?.beyond.includes(i));
    this.beyond.show(beyond.map(({ track }) => ({ name: track.label, hue: hueOf(track) })));
    this.panel.showEmpty(this.emptyText(state, all !== null));
    this.area.hidden = this.stage === null || this.lost || all === null;
    this.describe(state);
  }

  private emptyText(state: State, placed: boolean): string | null {
    if (this.stage === null) return kNoWebGl;
    if (this.lost) return kLost;
    if (placed) return null;
    if (state.runId === null) return 'Tracks of the flight appear here.';
    return tracksOf(state).some(({ shown }) => shown) ? 'No poses yet.' : 'No track is shown.';
  }

  /** The legend, and what a screen reader says. */
  private describe(state: State): void {
    const shown = (this.tracks?.all ?? []).map(({ track }) => track);
    const alignment = [...new Set(state.watched.map(shownAlignment))].join(', ');
    const estimates = shown.some(({ name }) => name !== '');
    const labels = shown.map(({ label }) => label);
    const named = legendEntries(shown, state.compared);
    rebuild(this.legend, JSON.stringify([alignment, named]), () => [
      ...named.map(legendLine),
      ...(estimates ? [h('span', { class: 'alignment-note' }, `by ${alignment}`)] : []),
    ]);
    setAttribute(
      this.area,
      'aria-label',
      `3D plot of ${labels.join(', ')}: turn with the arrows, move with Shift and the arrows, ` +
        'zoom with plus and minus, 0 shows all',
    );
    setAttribute(this.root, 'data-tracks', String(shown.length));
  }

  private size(): Size {
    return { width_px: this.area.clientWidth, height_px: this.area.clientHeight };
  }

  private redraw(): void {
    this.redrawInFrame(null);
  }

  private draw(): void {
    const { stage, tracks, view } = this;
    const size = this.size();
    if (stage === null || tracks === null || this.lost) return;
    if (size.width_px < 20 || size.height_px < 20) return;
    const { state } = this.context.store;
    const { current, map, scales, heightScale } = view;
    const axesPen = penOf(this.grid, size);
    if (axesPen !== null) paintAxes(axesPen, scales, current, map);
    stage.setGround(rgbOf(paint('var(--panel)')));
    tracks.setInstant(state, current.m_per_px);
    stage.draw(current, size, view.drawnBox, heightScale);
    const marksPen = penOf(this.marks, size);
    const options = { floor_m: scales[2].low, errorLines: this.errorLines };
    const marks = marksOf(state);
    if (marksPen !== null) paintMarks(marksPen, marks, current, map, options);
    setAttribute(this.root, 'data-marks', marksText(marks));
    this.draws += 1;
    setAttribute(this.root, 'data-draws', String(this.draws));
    setAttribute(this.root, 'data-points', String(tracks.pointCount));
  }

  private file(): PlotFile | null {
    const { tracks, view, context } = this;
    const { state } = context.store;
    if (tracks === null || tracks.all.length === 0) return null;
    const { current, map, scales } = view;
    const marked = { floor_m: scales[2].low, errorLines: this.errorLines };
    return {
      name: '3d',
      csv: () => tracksCsv(state),
      svg: () =>
        plot3dSvg(tracks.all, map, this.size(), state.clock?.t_ns ?? Infinity, {
          below: (pen) => paintAxes(pen, scales, current, map),
          above: (pen) => paintMarks(pen, marksOf(state), current, map, marked),
        }),
    };
  }

  private steer(): void {
    const { view, note, context } = this;
    const nearest = (at: Pixel, most_px: number) =>
      this.tracks?.nearest(view.map, at, most_px) ?? null;
    const point = perFrame<Pixel | null>((at) => {
      const found = at === null ? null : nearest(at, kHoverNear_px);
      if (found === null) note.hide();
      else note.show(found, view.map, this.size(), context.store.state);
    });
    const moved = (move: () => void) => {
      note.hide();
      move();
    };
    steerPlot(this.area, {
      turn: (dx_px, dy_px) => moved(() => view.turn(dx_px, dy_px)),
      pan: (dx_px, dy_px) => moved(() => view.pan(dx_px, dy_px)),
      zoom: (factor, at) => moved(() => view.zoom(factor, at)),
      fit: () => moved(() => view.fit()),
      point,
      click: (at) => {
        const found = nearest(at, kClickNear_px);
        if (found !== null) context.player.seekTime(found.t_ns);
      },
    });
  }

  /** The browser may take the context away and give it back. */
  private followContext(): void {
    const set = (lost: boolean) => {
      this.lost = lost;
      this.takeTracks(this.context.store.state);
      this.redraw();
    };
    this.lines.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      set(true);
    });
    this.lines.addEventListener('webglcontextrestored', () => set(false));
  }
}

/** Every shown track that has a pose at the clock's time. */
function marksOf(state: State): Mark[] {
  return tracksOf(state).flatMap((track) => {
    const { run, name, letter, label, shown } = track;
    const truth = run.instant?.truth ?? null;
    const pose = name === '' ? truth : run.instant?.estimates[name]?.pose;
    if (!shown || pose === undefined || pose === null) return [];
    return {
      label,
      place: [pose.x_m, pose.y_m, pose.z_m],
      axes: bodyAxes(pose),
      colour: trackColour(track),
      truth: name === '',
      letter: name === '' ? letter : '',
      truthPlace: name === '' || truth === null ? null : [truth.x_m, truth.y_m, truth.z_m],
    };
  });
}

/** Which aircraft are drawn and where [m]. */
function marksText(marks: readonly { label: string; place: readonly number[] }[]): string {
  return marks
    .map(({ label, place }) => [label, ...place.map((part) => part.toFixed(3))].join(' '))
    .join('; ');
}

/** Of a canvas that was cleared, in CSS pixels. */
function penOf(canvas: HTMLCanvasElement, size: Size): CanvasRenderingContext2D | null {
  const ratio = window.devicePixelRatio;
  const [width, height] = [Math.round(size.width_px * ratio), Math.round(size.height_px * ratio)];
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
  const pen = canvas.getContext('2d');
  pen?.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen?.clearRect(0, 0, size.width_px, size.height_px);
  return pen;
}
