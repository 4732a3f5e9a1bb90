// The page that calibrates a camera: choices, images with their corners, and the result.
import type { Topic } from '../../store/state';
import { viewerNote } from '../access';
import { h } from '../dom';
import type { Context, View } from '../view';
import { CaptureView } from './capture_view';
import { ResultView } from './result_view';
import { SavedList } from './saved_list';
import { SourceForm } from './source_form';

export class CalibrationPageView implements View {
  readonly root: HTMLElement;
  private readonly form: SourceForm;
  private readonly saved: SavedList;
  private readonly capture: CaptureView;
  private readonly result: ResultView;

  constructor(private readonly context: Context) {
    this.form = new SourceForm(context);
    this.saved = new SavedList(context);
    this.capture = new CaptureView(context);
    this.result = new ResultView(context);
    const close = h(
      'button',
      { class: 'icon-button', 'aria-label': 'Close', onclick: () => context.calibration.close() },
      '×',
    );
    this.root = h(
      'div',
      { class: 'calibration-page', role: 'dialog', 'aria-label': 'Calibrate a camera' },
      h('header', { class: 'log-header' }, h('h2', {}, 'Calibrate a camera'), close),
      h('div', { class: 'calibration-side' }, viewerNote(), this.form.root, this.saved.root),
      this.capture.root,
      this.result.root,
    );
  }

  update(changed: ReadonlySet<Topic>): void {
    if (!changed.has('calibration') && !changed.has('lists')) return;
    if (!this.context.store.state.calibrationPage.open) return;
    this.form.update();
    this.saved.update();
    this.capture.update();
    this.result.update();
  }
}
