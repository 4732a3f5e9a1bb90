// The 3D view, drawn by the server and controlled here.
import { formatNumber } from '../../store/format';
import { kNoRate } from '../../store/pictures/picture_rates';
import { refusalText, waitingText } from '../../store/pictures/waiting_text';
import { shownAlignment } from '../../store/state';
import type { Topic } from '../../store/state';
import { drawnTracks } from '../../store/tracks';
import { legendEntries, legendLine } from '../alignment_legend';
import { h, rebuild, setText } from '../dom';
import type { Panel } from '../panel';
import { makePanel } from '../panel';
import { movingRate, standingStill } from '../pictures/picture_panel';
import type { Context, View } from '../view';
import { LabelLayer } from './label_layer';
import { PictureCanvas } from './picture_canvas';
import { shootScene } from './scene_shot';
import { steerScene } from './scene_steering';
import { followSize } from './scene_size';
import { SceneTools } from './scene_tools';
import { sceneWish } from './scene_wish';

export class ScenePanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly picture = new PictureCanvas('3D view');
  private readonly tools: SceneTools;
  private readonly labels = new LabelLayer();
  private readonly legend = h('div', { class: 'legend' });
  private readonly readout = h('div', { class: 'scene-readout' });

  constructor(private readonly context: Context) {
    this.panel = makePanel('scene', '3D view');
    this.root = this.panel.root;
    const { body } = this.panel;
    this.tools = new SceneTools(context, () => {
      void shootScene(context, { width: body.clientWidth, height: body.clientHeight });
    });
    this.panel.tools.append(...this.tools.buttons);
    body.append(this.picture.canvas, this.labels.root, this.legend, this.readout, this.tools.sheet);
    steerScene(context, body);
    followSize(body, (width_px, height_px) => context.scene.setSize(width_px, height_px));
  }

  update(changed: ReadonlySet<Topic>): void {
    const { state } = this.context.store;
    if (changed.has('scene') || changed.has('run')) this.updateControls();
    // The second alignment comes and goes with the scores.
    if (changed.has('run') || changed.has('metrics')) {
      this.context.session.want('scene', sceneWish(state));
    }
    if (!changed.has('pictures') && !changed.has('playback') && !changed.has('run')) return;
    const picture = state.pictures.get('scene') ?? null;
    this.picture.show(picture);
    this.labels.draw(state, picture);
    const still = standingStill(state, state.main);
    this.picture.markStale(still?.t_ns ?? null);
    this.panel.showFrame(picture?.frame ?? null, still?.frame ?? null);
    const { main } = state;
    const refusal = main === null ? null : refusalText(main, 'scene');
    this.panel.showEmpty(picture === null ? (refusal ?? waitingText(main)) : null);
    this.panel.showRate(main === null ? kNoRate : movingRate(state, main, 'scene'));
  }

  onHidden(): void {
    this.context.session.want('scene', []);
  }

  private updateControls(): void {
    const { state } = this.context.store;
    this.tools.draw(state);
    const { mode, orbits, eye } = state.scene;
    const { azimuth_deg, elevation_deg, distance_m } = orbits[mode];
    const angles = `${formatNumber(azimuth_deg, 0)}° ${formatNumber(elevation_deg, 0)}°`;
    const place = [eye.x_m, eye.y_m, eye.z_m].map((value) => formatNumber(value, 0)).join(' ');
    const far = mode === 'free' ? ` · ${place} m` : ` · ${formatNumber(distance_m, 0)} m`;
    setText(this.readout, angles + (mode === 'onboard' ? '' : far));
    const tracks = drawnTracks(state);
    const alignment = [...new Set(state.watched.map(shownAlignment))].join(', ');
    // Unlike curves, ribbons are never dashed to repeat a colour.
    const entries = legendEntries(tracks, state.compared).map((entry, i) => ({
      ...entry,
      dashed: tracks[i]?.by !== undefined,
    }));
    rebuild(this.legend, JSON.stringify([state.runId, alignment, entries]), () => [
      ...entries.map(legendLine),
      ...(tracks.length < 2 ? [] : [h('span', { class: 'alignment-note' }, `by ${alignment}`)]),
    ]);
  }
}
