// Differences of images: what the sensor and faults did to the camera's image, or how far off the
// view from an estimated pose is.
import { picturesOf } from '../../connection/stream_client';
import { cameraGroup, shownCamera } from '../../store/pictures/picture_groups';
import { waitingText } from '../../store/pictures/waiting_text';
import type { State, Topic } from '../../store/state';
import type { WatchedRun } from '../../store/watched_run';
import { h, rebuild } from '../dom';
import type { Context } from '../view';
import { estimatorCamera } from './debug_panel';
import type { CellStream } from './picture_panel';
import { PicturePanel } from './picture_panel';

const kEffects = '';
const kStream = { max_hz: 10, quality: 85 };

export class ImageErrorPanel extends PicturePanel {
  private readonly chooser = h('select', {
    id: 'image-error-of',
    'aria-label': 'What is compared',
  });

  constructor(context: Context) {
    super(context, 'image-error', 'Image error');
    this.panel.tools.prepend(this.chooser);
    this.chooser.addEventListener('change', () => {
      const { value } = this.chooser;
      context.store.state.imageErrorOf = value === kEffects ? null : value;
      context.store.change('pictures');
    });
  }

  override update(changed: ReadonlySet<Topic>): void {
    if (changed.has('run')) this.updateChooser();
    super.update(changed);
    if (changed.has('playback') || changed.has('run')) void this.context.cameras.refresh();
  }

  protected override streamOf(watched: WatchedRun): CellStream | null {
    const { selected } = this;
    return selected === kEffects ? effects(watched) : poseError(watched, selected);
  }

  protected override emptyText(state: State): string {
    return waitingText(state.main);
  }

  /** The estimator whose view is compared, of the main run; else the camera's image itself. */
  private get selected(): string {
    const { imageErrorOf, run } = this.context.store.state;
    const known = imageErrorOf !== null && run?.estimators.includes(imageErrorOf) === true;
    return known ? imageErrorOf : kEffects;
  }

  private updateChooser(): void {
    const names = this.context.store.state.run?.estimators ?? [];
    rebuild(this.chooser, JSON.stringify(names), () => [
      h('option', { value: kEffects }, 'Sensor and faults'),
      ...names.map((name) => h('option', { value: name }, `Pose of ${name}`)),
    ]);
    this.chooser.value = this.selected;
  }
}

function effects(watched: WatchedRun): CellStream {
  const camera = shownCamera(watched);
  return {
    stream: { name: 'error', ...(camera === null ? {} : { camera }), ...kStream },
    key: picturesOf('error', camera ?? undefined),
    group: cameraGroup(camera),
    asks: { camera, picture: 'error' },
    legend: { of: 'error', label: 'Received − ideal [grey levels]' },
    empty: waitingText(watched),
  };
}

function poseError(watched: WatchedRun, estimator: string): CellStream | null {
  if (watched.run?.estimators.includes(estimator) !== true) return null;
  const camera = estimatorCamera(watched, estimator);
  const name = `error/${estimator}`;
  return {
    stream: { name, ...kStream },
    key: name,
    group: cameraGroup(camera),
    asks: { camera, picture: name },
    legend: { of: 'error', label: 'Estimate − truth [grey levels]' },
    empty: `${estimator} has no pose at this instant.`,
  };
}
