// The 3D view, drawn by the server and controlled here. Dragging turns the view, the wheel zooms.
import type { PictureStream, SceneMode } from '../../protocol/messages';
import { rateText } from '../../store/pictures/picture_rates';
import { shownAlignment } from '../../store/state';
import type { State, Topic } from '../../store/state';
import { h, perFrame } from '../dom';
import { formatNumber } from '../../store/format';
import { tracksOf } from '../../store/tracks';
import { estimateColour, kTruthColour } from '../colours';
import { rebuild, setAttribute, setText } from '../dom';
import type { Panel } from '../panel';
import { makePanel } from '../panel';
import { PictureCanvas } from './picture_canvas';
import { standingStill, waitingText } from './picture_panel';
import type { Context, View } from '../view';

const kModes: readonly { mode: SceneMode; label: string; key: string }[] = [
  { mode: 'chase', label: 'Chase', key: '1' },
  { mode: 'orbit', label: 'Orbit', key: '2' },
  { mode: 'top', label: 'Top', key: '3' },
];

const kTurn_deg_px = 0.35;
const kZoom_per_px = 0.0012;
const kResizeWait_ms = 150;
const kWidthRange_px = [64, 1920] as const;
const kHeightRange_px = [64, 1440] as const;

export class ScenePanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly picture = new PictureCanvas('3D view');
  private readonly modeButtons = new Map<SceneMode, HTMLElement>();
  private readonly followButton: HTMLElement;
  private readonly legend = h('div', { class: 'legend' });
  private readonly readout = h('div', { class: 'scene-readout' });

  constructor(private readonly context: Context) {
    this.panel = makePanel('scene', '3D view');
    this.root = this.panel.root;
    for (const { mode, label, key } of kModes) {
      const button = h(
        'button',
        {
          class: 'tab',
          title: `${label} view (${key})`,
          onclick: () => context.scene.setMode(mode),
        },
        label,
      );
      this.modeButtons.set(mode, button);
      this.panel.tools.append(button);
    }
    this.followButton = h(
      'button',
      {
        class: 'tab follow',
        title: 'Keep the aircraft in the middle (F)',
        onclick: () => context.scene.toggleFollow(),
      },
      'Follow',
    );
    this.panel.tools.append(this.followButton);
    this.panel.body.append(this.picture.canvas, this.legend, this.readout);
    this.steer(this.panel.body);
    this.observeSize(this.panel.body);
  }

  update(changed: ReadonlySet<Topic>): void {
    const { state } = this.context.store;
    if (changed.has('scene') || changed.has('run')) this.updateControls();
    if (changed.has('run')) this.context.session.want('scene', sceneWish(state));
    if (!changed.has('pictures') && !changed.has('playback') && !changed.has('run')) return;
    const picture = state.pictures.get('scene') ?? null;
    this.picture.show(picture);
    const still = standingStill(state, state.main);
    this.picture.markStale(still?.t_ns ?? null);
    this.panel.showFrame(picture?.frame ?? null, still?.frame ?? null);
    this.panel.showEmpty(picture === null ? waitingText(state.main) : null);
    this.panel.showRate(rateText(state.rates.get('scene')));
  }

  onHidden(): void {
    this.context.session.want('scene', []);
  }

  private updateControls(): void {
    const { state } = this.context.store;
    const orbit = state.sceneOrbits[state.sceneMode];
    for (const [mode, button] of this.modeButtons) {
      setAttribute(button, 'aria-pressed', mode === state.sceneMode ? 'true' : 'false');
    }
    setAttribute(this.followButton, 'aria-pressed', orbit.follow ? 'true' : 'false');
    this.followButton.toggleAttribute('disabled', state.sceneMode === 'chase');
    const angles = `${formatNumber(orbit.azimuth_deg, 0)}° ${formatNumber(orbit.elevation_deg, 0)}°`;
    setText(this.readout, `${angles} · ${formatNumber(orbit.distance_m, 0)} m`);
    const tracks = tracksOf(state);
    const alignment = [...new Set(state.watched.map(shownAlignment))].join(', ');
    const key = JSON.stringify([state.runId, alignment, tracks.map(({ label }) => label)]);
    rebuild(this.legend, key, () => [
      ...tracks.map(({ name, label, colour }) =>
        legendEntry(label, name === '' ? kTruthColour : estimateColour(colour)),
      ),
      ...(tracks.length < 2 ? [] : [h('span', { class: 'alignment-note' }, `by ${alignment}`)]),
    ]);
  }

  private steer(area: HTMLElement): void {
    const { scene, store } = this.context;
    const current = () => store.state.sceneOrbits[store.state.sceneMode];
    let last: { x: number; y: number } | null = null;
    area.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      last = { x: event.clientX, y: event.clientY };
      area.setPointerCapture(event.pointerId);
    });
    area.addEventListener('pointermove', (event) => {
      if (last === null) return;
      const { azimuth_deg, elevation_deg } = current();
      scene.orbit({
        azimuth_deg: azimuth_deg + (event.clientX - last.x) * kTurn_deg_px,
        elevation_deg: elevation_deg + (event.clientY - last.y) * kTurn_deg_px,
      });
      last = { x: event.clientX, y: event.clientY };
    });
    const release = () => {
      last = null;
    };
    area.addEventListener('pointerup', release);
    area.addEventListener('pointercancel', release);
    area.addEventListener('dblclick', () => scene.toggleFollow());
    area.addEventListener(
      'wheel',
      (event) => {
        event.preventDefault();
        scene.orbit({ distance_m: current().distance_m * Math.exp(event.deltaY * kZoom_per_px) });
      },
      { passive: false },
    );
  }

  /** Requests pictures of the panel's size once the size is stable. */
  private observeSize(area: HTMLElement): void {
    let timer = 0;
    let asked = '';
    const ask = perFrame((size: { width: number; height: number }) => {
      const width_px = even(size.width * window.devicePixelRatio, kWidthRange_px);
      const height_px = even(size.height * window.devicePixelRatio, kHeightRange_px);
      const key = `${width_px}x${height_px}`;
      if (key === asked) return;
      asked = key;
      this.context.scene.setSize(width_px, height_px);
    });
    new ResizeObserver(([entry]) => {
      if (entry === undefined) return;
      const { width, height } = entry.contentRect;
      clearTimeout(timer);
      timer = window.setTimeout(() => ask({ width, height }), asked === '' ? 0 : kResizeWait_ms);
    }).observe(area);
  }
}

/** The scene with all watched runs, each with the colours of its tracks in the plots. */
function sceneWish(state: State): PictureStream[] {
  const { main } = state;
  if (main === null) return [];
  const firsts = tracksOf(state).filter(({ name }) => name === '');
  const all = firsts.map(({ run, colour }) => ({ run: run.id, first_colour: colour }));
  const own = all.find(({ run }) => run === main.id);
  return [
    {
      run: main.id,
      name: 'scene',
      max_hz: 20,
      quality: 80,
      ...(own === undefined || own.first_colour === 0 ? {} : { first_colour: own.first_colour }),
      ...(all.length < 2 ? {} : { with: all.filter((one) => one !== own) }),
    },
  ];
}

function legendEntry(name: string, colour: string): HTMLElement {
  return h('span', {}, h('i', { style: `background:${colour}` }), name);
}

function even(value: number, [low, high]: readonly [number, number]): number {
  return Math.min(high, Math.max(low, Math.round(value / 2) * 2));
}
