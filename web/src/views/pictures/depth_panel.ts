// The depth of the ground in the camera's image.
import { picturesOf } from '../../connection/stream_client';
import { cameraGroup, shownCamera } from '../../store/pictures/picture_groups';
import { waitingText } from '../../store/pictures/waiting_text';
import type { State, Topic } from '../../store/state';
import type { WatchedRun } from '../../store/watched_run';
import type { Context } from '../view';
import { CameraChooser } from './camera_chooser';
import type { CellStream } from './picture_panel';
import { PicturePanel } from './picture_panel';

export class DepthPanel extends PicturePanel {
  private readonly chooser: CameraChooser;

  constructor(context: Context) {
    super(context, 'depth', 'Depth');
    this.chooser = new CameraChooser(context, 'depth-camera');
    this.panel.tools.prepend(this.chooser.root);
  }

  override update(changed: ReadonlySet<Topic>): void {
    super.update(changed);
    if (changed.has('playback') || changed.has('run')) void this.context.cameras.refresh();
    if (changed.has('cameras') || changed.has('run')) this.chooser.draw(this.context.store.state);
  }

  protected override streamOf(watched: WatchedRun): CellStream {
    const camera = shownCamera(watched);
    return {
      stream: { name: 'depth', ...(camera === null ? {} : { camera }), max_hz: 10, quality: 85 },
      key: picturesOf('depth', camera ?? undefined),
      group: cameraGroup(camera),
      asks: { camera, picture: 'depth' },
      legend: { of: 'depth', label: 'Depth [m]' },
      empty: waitingText(watched),
    };
  }

  protected override emptyText(state: State): string {
    return waitingText(state.main);
  }
}
