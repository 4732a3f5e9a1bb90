// The aircraft's camera: its picture, details of the frame, and active faults.
import { frameInfo } from '../store/frame_info';
import type { FrameInfo } from '../store/frame_info';
import { faultMeaning } from '../store/fault_spans';
import { cameraPictures } from '../store/state';
import type { State, Topic } from '../store/state';
import { faultColour } from './colours';
import { h, rebuild, setAttribute, setText } from './dom';
import { PicturePanel, waitingText } from './picture_panel';
import type { Context } from './view';

export class CameraPanel extends PicturePanel {
  private readonly chooser = h('select', { id: 'camera', 'aria-label': 'Camera', hidden: true });
  private readonly lens = h('span', { class: 'lens', 'data-role': 'lens' });
  private readonly marks = h('div', { class: 'fault-marks' });
  private readonly figures = h('div', { class: 'frame-figures', 'data-role': 'figures' });

  constructor(context: Context) {
    super(context, 'camera', 'Camera');
    this.panel.tools.append(this.chooser, this.lens);
    this.panel.body.append(this.marks);
    this.root.append(this.figures);
    this.chooser.addEventListener('change', () => {
      const first = this.chooser.selectedIndex === 0;
      context.session.setCamera(first ? null : this.chooser.value);
    });
    new ResizeObserver(([entry]) => {
      if (entry === undefined) return;
      const width_px = entry.contentRect.width * window.devicePixelRatio;
      context.session.setPictureWidth(width_px > 660 ? 1280 : 640);
    }).observe(this.panel.body);
  }

  override update(changed: ReadonlySet<Topic>): void {
    super.update(changed);
    if (changed.has('playback') || changed.has('run')) void this.context.cameras.refresh();
    if (changed.has('cameras') || changed.has('run')) this.updateChooser();
    const rows = changed.has('pictures') || changed.has('rows') || changed.has('run');
    if (rows || changed.has('cameras')) this.updateInfo();
  }

  protected override streamOf(state: State): string {
    return cameraPictures(state);
  }

  protected override emptyText(state: State): string {
    return waitingText(state);
  }

  private updateChooser(): void {
    const { cameras, camera } = this.context.store.state;
    rebuild(this.chooser, JSON.stringify(cameras), () =>
      cameras.map(({ name }) => h('option', { value: name }, name)),
    );
    this.chooser.hidden = cameras.length < 2;
    const shown = cameras.find(({ name }) => name === camera) ?? cameras[0];
    if (shown !== undefined) this.chooser.value = shown.name;
    const model = shown?.distortion?.model ?? 'none';
    const size = shown === undefined ? '' : `${shown.width_px}×${shown.height_px} px`;
    setText(this.lens, shown === undefined || model === 'none' ? size : `${model} · ${size}`);
    // A narrow panel shows only the beginning: the lens, if there is one.
    this.lens.title = model === 'none' ? `${size}, no distortion` : `${size}, distortion: ${model}`;
  }

  private updateInfo(): void {
    const { state } = this.context.store;
    const info = frameInfo(state.data, this.frame);
    const first = state.cameras[0]?.name;
    const other = state.camera !== null && state.camera !== first;
    setAttribute(this.root, 'data-faults', other ? null : (info?.faults.join(' ') ?? null));
    rebuild(this.marks, JSON.stringify(other ? [] : [info?.faults, info?.marks]), () =>
      other || info === null ? [] : faultMarks(info),
    );
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
