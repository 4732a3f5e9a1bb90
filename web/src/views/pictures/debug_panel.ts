// The debug images of the estimators.
import { cameraGroup } from '../../store/pictures/picture_groups';
import { waitingText } from '../../store/pictures/waiting_text';
import type { State, Topic } from '../../store/state';
import type { WatchedRun } from '../../store/watched_run';
import { h, rebuild } from '../dom';
import type { Context } from '../view';
import type { CellStream } from './picture_panel';
import { PicturePanel } from './picture_panel';

export class DebugPanel extends PicturePanel {
  private readonly chooser = h('select', { id: 'debug-of', 'aria-label': 'Estimator' });

  constructor(context: Context) {
    super(context, 'debug', 'Estimator');
    this.panel.tools.prepend(this.chooser);
    this.chooser.addEventListener('change', () => {
      context.store.state.debugOf = this.chooser.value;
      context.store.change('pictures');
    });
  }

  override update(changed: ReadonlySet<Topic>): void {
    if (changed.has('run')) this.updateChooser();
    super.update(changed);
  }

  protected override streamOf(watched: WatchedRun): CellStream | null {
    const estimator = this.estimatorOf(watched);
    if (estimator === null) return null;
    const name = `debug/${estimator}`;
    const camera = estimatorCamera(watched, estimator);
    const recorded = watched.run !== null && this.context.store.state.clock?.live === false;
    return {
      stream: { name, max_hz: 15, quality: 75 },
      key: name,
      group: this.showsCamera(watched, camera, name) ? cameraGroup(camera) : name,
      asks: this.showsCamera(watched, camera, name) ? { camera, picture: 'camera' } : null,
      legend: null,
      empty: recorded ? 'No debug image at this instant.' : waitingText(watched),
    };
  }

  protected override emptyText(state: State): string {
    const none = state.run !== null && state.run.estimators.length === 0;
    return none ? 'This flight has no estimators.' : waitingText(state.main);
  }

  /** An estimator may draw anything; what has the camera's shape shows the camera's image. */
  private showsCamera(watched: WatchedRun, camera: string | null, key: string): boolean {
    const picture = watched.pictures.get(key);
    const info = watched.cameras.find(({ name }) => name === camera) ?? watched.cameras[0];
    if (picture === undefined || info === undefined) return false;
    const same = picture.fullWidth_px * info.height_px - picture.fullHeight_px * info.width_px;
    return Math.abs(same) <= info.width_px;
  }

  private estimatorOf({ run }: WatchedRun): string | null {
    const names = run?.estimators ?? [];
    const { debugOf } = this.context.store.state;
    return debugOf !== null && names.includes(debugOf) ? debugOf : (names[0] ?? null);
  }

  private updateChooser(): void {
    const { main } = this.context.store.state;
    const names = main?.run?.estimators ?? [];
    rebuild(this.chooser, JSON.stringify(names), () =>
      names.map((name) => h('option', { value: name }, name)),
    );
    this.chooser.hidden = names.length === 0;
    this.chooser.value = (main === null ? null : this.estimatorOf(main)) ?? '';
  }
}

/** The camera whose images an estimator gets; null = the first. */
export function estimatorCamera({ cameras, estimatorCameras }: WatchedRun, name: string) {
  const camera = estimatorCameras.get(name) ?? null;
  return camera === cameras[0]?.name ? null : camera;
}
