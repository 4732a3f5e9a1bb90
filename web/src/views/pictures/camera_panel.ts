// The aircraft's camera: its picture, details of the frame, and active faults.
import { picturesOf } from '../../connection/stream_client';
import { faultMeaning } from '../../store/fault_spans';
import { frameInfo } from '../../store/pictures/frame_info';
import type { FrameInfo } from '../../store/pictures/frame_info';
import { cameraGroup, shownCamera } from '../../store/pictures/picture_groups';
import { waitingText } from '../../store/pictures/waiting_text';
import type { State, Topic } from '../../store/state';
import type { WatchedRun } from '../../store/watched_run';
import { faultColour } from '../colours';
import { h, rebuild, setAttribute, setText } from '../dom';
import type { Context } from '../view';
import { CameraChooser } from './camera_chooser';
import type { CellStream } from './picture_panel';
import { PicturePanel } from './picture_panel';

export class CameraPanel extends PicturePanel {
  private readonly chooser: CameraChooser;
  private readonly lens = h('span', { class: 'lens', 'data-role': 'lens' });
  private readonly figures = h('div', { class: 'frame-figures', 'data-role': 'figures' });

  constructor(context: Context) {
    super(context, 'camera', 'Camera');
    this.chooser = new CameraChooser(context, 'camera');
    this.panel.tools.prepend(this.chooser.root, this.lens);
    this.root.append(this.figures);
  }

  override update(changed: ReadonlySet<Topic>): void {
    super.update(changed);
    if (changed.has('playback') || changed.has('run')) void this.context.cameras.refresh();
    if (changed.has('cameras') || changed.has('run')) this.updateLens();
    const rows = changed.has('pictures') || changed.has('rows') || changed.has('run');
    if (rows || changed.has('cameras')) this.updateInfo();
  }

  protected override streamOf(watched: WatchedRun): CellStream {
    const camera = shownCamera(watched);
    return {
      stream: { name: 'camera', ...(camera === null ? {} : { camera }), max_hz: 31, quality: 75 },
      key: picturesOf('camera', camera ?? undefined),
      group: cameraGroup(camera),
      asks: { camera, picture: 'camera' },
      legend: null,
      empty: waitingText(watched),
    };
  }

  protected override emptyText(state: State): string {
    return waitingText(state.main);
  }

  private updateLens(): void {
    const { state } = this.context.store;
    this.chooser.draw(state);
    const { cameras, camera } = state;
    const shown = cameras.find(({ name }) => name === camera) ?? cameras[0];
    const model = shown?.distortion?.model ?? 'none';
    const size = shown === undefined ? '' : `${shown.width_px}×${shown.height_px} px`;
    setText(this.lens, shown === undefined || model === 'none' ? size : `${model} · ${size}`);
    // A narrow panel shows only the beginning: the lens, if there is one.
    this.lens.title = model === 'none' ? `${size}, no distortion` : `${size}, distortion: ${model}`;
  }

  /** Faults of the shown frame of each run, and figures of the main one's. */
  private updateInfo(): void {
    const { state } = this.context.store;
    for (const [id, view] of this.views) {
      const watched = state.watchedRun(id);
      const cell = watched === undefined ? null : this.streamOf(watched);
      const frame = watched?.pictures.get(cell?.key ?? '')?.frame ?? null;
      const first = watched !== undefined && shownCamera(watched) === null;
      const info = first ? frameInfo(watched.data, frame) : null;
      rebuild(view.marks, JSON.stringify([info?.faults, info?.marks]), () =>
        info === null ? [] : faultMarks(info),
      );
    }
    const info = frameInfo(state.data, this.frame);
    const first = state.cameras[0]?.name;
    const other = state.main !== null && shownCamera(state.main) !== null;
    setAttribute(this.root, 'data-faults', other ? null : (info?.faults.join(' ') ?? null));
    const key = JSON.stringify([info?.figures, other, state.runId === null]);
    rebuild(this.figures, key, () => {
      if (other)
        return [h('span', { class: 'note' }, `Values are recorded only for ${first ?? ''}`)];
      return figureList(info);
    });
  }
}

function faultMarks({ faults, marks }: FrameInfo): HTMLElement[] {
  return faults.map((kind) => {
    const { label, mark, hint } = faultMeaning(kind);
    const strong = mark !== null && marks.includes(mark);
    return h(
      'span',
      {
        class: strong ? 'fault-mark strong' : 'fault-mark',
        style: `border-color:${faultColour(kind)}`,
        'data-fault-kind': kind,
        title: `Fault of the scenario: ${hint}`,
      },
      mark ?? label,
    );
  });
}

const kLabels = ['Exposure', 'Gain', 'Saturated', 'Texels/px', 'Late tiles'];

/** Without a frame, placeholders keep the layout stable. */
function figureList(info: FrameInfo | null): HTMLElement[] {
  const figures =
    info?.figures ?? kLabels.map((label) => ({ key: '', label, text: '–', hint: '', warn: false }));
  return figures.map(({ key, label, text, hint, warn }) =>
    h(
      'span',
      { class: warn ? 'figure warn' : 'figure', 'data-figure': key, title: hint },
      h('i', {}, label),
      h('b', {}, text),
    ),
  );
}
