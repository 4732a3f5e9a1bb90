// Chooses the source of the images, the board and the lens, and begins a calibration.
import { ambiguityOf, kSourceKinds } from '../../store/calibration/calibration_form';
import type { CalibrationForm, SourceKind } from '../../store/calibration/calibration_form';
import type { CalibrationPage } from '../../store/calibration/calibration_page';
import { h, rebuild, setText } from '../dom';
import type { Context } from '../view';

const kKinds: Readonly<Record<SourceKind, { label: string; none: string }>> = {
  scenario: { label: 'Camera of a scenario', none: 'The server has no scenarios.' },
  folder: { label: 'Images in a folder', none: 'There are no images in the data folders.' },
  upload: { label: 'Images of this computer', none: '' },
  recording: { label: 'Recording or video', none: 'There are no recordings in the data folders.' },
  camera: {
    label: 'Live camera',
    none: 'This server may open no camera. It is allowed with overfly serve --allow-camera ADDRESS.',
  },
};

const kBoardChoices = [
  ['checkerboard', 'Chequerboard'],
  ['4x4', 'ChArUco, markers 4x4'],
  ['5x5', 'ChArUco, markers 5x5'],
  ['6x6', 'ChArUco, markers 6x6'],
] as const;

const kModelChoices = [
  ['radtan', 'Pinhole, radtan'],
  ['equidistant', 'Pinhole, equidistant'],
  ['none', 'Pinhole, no distortion'],
] as const;

type TextField = 'topic' | 'views' | 'cols' | 'rows' | 'square_mm' | 'marker_mm';

export class SourceForm {
  readonly root: HTMLElement;
  private readonly kind = h('select', { id: 'calibration-kind' });
  private readonly name = h('select', { id: 'calibration-name' });
  private readonly none = h('p', { class: 'log-note' });
  private readonly camera = h('select', { id: 'calibration-camera' });
  private readonly board = h('select', { id: 'calibration-board' });
  private readonly model = h('select', { id: 'calibration-model' });
  private readonly k3 = h('input', { type: 'checkbox', id: 'calibration-k3' });
  private readonly symmetric = h('input', { type: 'checkbox', id: 'calibration-symmetric' });
  private readonly ambiguity = h('p', { class: 'calibration-warning', role: 'alert' });
  private readonly inputs: Record<TextField, HTMLInputElement>;
  private readonly rows: Record<string, HTMLElement>;
  private readonly start = h('button', { class: 'primary', 'data-role': 'begin-calibration' });

  constructor(private readonly context: Context) {
    this.inputs = {
      topic: this.input('topic', 'text'),
      views: this.input('views'),
      cols: this.input('cols'),
      rows: this.input('rows'),
      square_mm: this.input('square_mm'),
      marker_mm: this.input('marker_mm'),
    };
    this.inputs.topic.placeholder = 'the only one';
    fill(
      this.kind,
      kSourceKinds.map((kind) => [kind, kKinds[kind].label]),
    );
    fill(this.board, kBoardChoices);
    fill(this.model, kModelChoices);
    const { name, camera, k3, symmetric } = this;
    const { topic, views, cols, rows, square_mm, marker_mm } = this.inputs;
    this.rows = {
      name: field('From', name),
      topic: field('Topic', topic, '', 'Topic or channel with the images'),
      camera: field('Camera', camera),
      views: field('Views', views, '', 'Images of the virtual board'),
      marker: field('Marker', marker_mm, 'mm', 'Side of a marker with its dark border'),
      k3: h('label', { class: 'calibration-check' }, k3, 'Estimate k3 too'),
      symmetric: h('label', { class: 'calibration-check' }, symmetric, 'Use this board anyway'),
    };
    this.root = h(
      'div',
      { class: 'calibration-form', 'data-changes': true },
      h('h3', {}, 'Images'),
      field('Source', this.kind),
      this.row('name'),
      this.none,
      this.row('topic'),
      this.row('camera'),
      this.row('views'),
      h('h3', {}, 'Board'),
      field('Kind', this.board),
      field('Columns', cols, '', 'Inner corners in a row: one less than squares'),
      field('Rows', rows, '', 'Inner corners in a column: one less than squares'),
      field('Square', square_mm, 'mm', 'Side of a square'),
      this.row('marker'),
      this.ambiguity,
      this.row('symmetric'),
      h('h3', {}, 'Lens'),
      field('Model', this.model),
      this.row('k3'),
      this.start,
    );
    this.listen();
  }

  private input(name: TextField, type = 'number'): HTMLInputElement {
    const input = h('input', { type, id: `calibration-${name}` });
    input.addEventListener('input', () => this.context.calibration.set({ [name]: input.value }));
    return input;
  }

  private listen(): void {
    const { calibration } = this.context;
    const on = (control: HTMLElement, act: () => void) => control.addEventListener('change', act);
    on(this.kind, () => calibration.set({ kind: this.kind.value as SourceKind }));
    on(this.name, () => void calibration.chooseName(this.name.value));
    on(this.camera, () => calibration.set({ camera: this.camera.value }));
    on(this.board, () => calibration.set({ board: this.board.value as CalibrationForm['board'] }));
    on(this.model, () => calibration.set({ model: this.model.value }));
    on(this.k3, () => calibration.set({ k3: this.k3.checked }));
    on(this.symmetric, () => calibration.set({ acceptSymmetric: this.symmetric.checked }));
    this.start.addEventListener('click', () => void calibration.begin());
  }

  update(): void {
    const { scenarios, calibrationPage: page } = this.context.store.state;
    const { form } = page;
    this.kind.value = form.kind;
    this.board.value = form.board;
    this.model.value = form.model;
    this.k3.checked = form.k3;
    this.symmetric.checked = form.acceptSymmetric;
    for (const [name, input] of Object.entries(this.inputs)) {
      const text = form[name as TextField];
      if (input.value !== text) input.value = text;
    }
    const names = namesOf(page, scenarios);
    fill(this.name, names);
    this.name.value = form.names[form.kind];
    fill(
      this.camera,
      (page.cameras ?? []).map((name) => [name, name]),
    );
    this.camera.value = form.camera;
    this.showRows(form, names.length, page.cameras?.length ?? 0);
    const ambiguity = ambiguityOf(form);
    setText(this.ambiguity, ambiguity ?? '');
    this.ambiguity.hidden = ambiguity === null;
    this.row('symmetric').hidden = ambiguity === null;
    this.start.disabled = page.busy || (form.kind !== 'upload' && names.length === 0);
    setText(this.start, page.session === null ? 'Start' : 'Start again');
  }

  private showRows(form: CalibrationForm, names: number, cameras: number): void {
    const { kind } = form;
    this.row('name').hidden = kind === 'upload' || names === 0;
    this.none.hidden = kind === 'upload' || names > 0;
    setText(this.none, kKinds[kind].none);
    this.row('topic').hidden = kind !== 'recording';
    this.row('camera').hidden = kind !== 'scenario' || cameras < 2;
    this.row('views').hidden = kind !== 'scenario';
    this.row('marker').hidden = form.board === 'checkerboard';
    this.row('k3').hidden = form.model !== 'radtan';
  }

  private row(name: string): HTMLElement {
    return this.rows[name] as HTMLElement;
  }
}

/** Value and label of each choice. */
function namesOf(
  { form, sources }: CalibrationPage,
  scenarios: readonly { name: string; title: string; error: string | null }[] | null,
): [string, string][] {
  switch (form.kind) {
    case 'scenario':
      return (scenarios ?? [])
        .filter(({ error }) => error === null)
        .map(({ name, title }) => [name, title]);
    case 'folder':
      return (sources?.folders ?? []).map(({ name, images }) => [name, `${name} (${images})`]);
    case 'recording':
      return (sources?.recordings ?? []).map(({ name }) => [name, name]);
    case 'camera':
      return (sources?.cameras ?? []).map(({ name }) => [name, name]);
    case 'upload':
      return [];
  }
}

function field(label: string, control: HTMLElement, unit = '', hint = ''): HTMLElement {
  return h(
    'div',
    { class: 'calibration-field', title: hint },
    h('label', { for: control.id }, label),
    control,
    h('span', { class: 'unit' }, unit),
  );
}

function fill(select: HTMLSelectElement, choices: readonly (readonly [string, string])[]): void {
  rebuild(select, JSON.stringify(choices), () =>
    choices.map(([value, label]) => h('option', { value }, label)),
  );
}
