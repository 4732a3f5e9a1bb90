// Saved calibrations: download for other programs, use in a scenario, delete.
import { formatNumber } from '../../store/format';
import type { SavedCalibration } from '../../protocol/calibration_types';
import { kCameraFormats } from '../../protocol/calibration_types';
import { deleteButton } from '../delete_button';
import { h, rebuild, setText } from '../dom';
import { download } from '../download';
import type { Context } from '../view';

const kFormats: Readonly<Record<(typeof kCameraFormats)[number], string>> = {
  overfly: 'Overfly JSON',
  'orb-slam2': 'ORB-SLAM2 YAML',
  dso: 'DSO camera.txt',
  svo: 'SVO YAML',
  ros: 'ROS camera_info YAML',
  kalibr: 'Kalibr camchain YAML',
};

export class SavedList {
  readonly root: HTMLElement;
  private readonly list = h('ul', { class: 'saved-list' });
  private readonly note = h('p', { class: 'log-note' });

  constructor(private readonly context: Context) {
    this.root = h(
      'div',
      { class: 'calibration-saved', 'data-role': 'saved-calibrations' },
      h('h3', {}, 'Saved calibrations'),
      this.list,
      this.note,
    );
  }

  update(): void {
    const { saved, listError, sources } = this.context.store.state.calibrationPage;
    rebuild(this.list, JSON.stringify(saved), () =>
      (saved ?? []).map((entry) => this.entry(entry)),
    );
    setText(
      this.note,
      listError ??
        (sources?.keeps === false
          ? 'This server keeps no calibrations, because it takes no uploads.'
          : saved?.length === 0
            ? 'None yet.'
            : ''),
    );
    this.note.hidden = this.note.textContent === '';
  }

  private entry(saved: SavedCalibration): HTMLElement {
    const { calibration } = this.context;
    const { name, file } = saved;
    const choice = h(
      'select',
      { 'aria-label': `Download ${name}`, title: 'For other programs' },
      h('option', { value: '' }, 'Download'),
      ...kCameraFormats.map((format) => h('option', { value: format }, kFormats[format])),
    );
    choice.addEventListener('change', () => {
      const format = choice.value;
      choice.value = '';
      void this.save(name, format);
    });
    return h(
      'li',
      { 'data-calibration': name },
      h('b', { title: file }, name),
      h('span', { class: 'unit' }, summaryOf(saved)),
      h(
        'span',
        { class: 'saved-actions' },
        h(
          'button',
          {
            class: 'tab',
            'data-changes': true,
            title: 'The next flight of the scenario in the launcher uses this camera',
            onclick: () => calibration.useInScenario(file, name),
          },
          'Use in next flight',
        ),
        choice,
        deleteButton(name, 'this calibration', () => void calibration.remove(name)),
      ),
    );
  }

  private async save(name: string, format: string): Promise<void> {
    const file = await this.context.calibration.file(name, format);
    if (file !== null) download(fileName(name, format), file);
  }
}

function summaryOf({ error, width_px, height_px, model, fx_px, rms_px }: SavedCalibration): string {
  if (error !== undefined) return error;
  const focal = fx_px === undefined ? '' : `, fx ${formatNumber(fx_px, 1)} px`;
  const rms = typeof rms_px === 'number' ? `, RMS ${formatNumber(rms_px, 3)} px` : '';
  return `${width_px} x ${height_px} px, ${model}${focal}${rms}`;
}

function fileName(name: string, format: string): string {
  if (format === 'overfly') return `${name}.json`;
  return format === 'dso' ? `${name}-dso.txt` : `${name}-${format}.yaml`;
}
