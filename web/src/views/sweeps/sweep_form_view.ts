// Prepares a sweep: a sweep file of the server or its JSON, a name, what it costs.
import type { FieldError } from '../../protocol/field_errors';
import { formatDuration } from '../../store/format';
import type { SweepFormState } from '../../store/sweeps/sweep_form';
import { h, rebuild, setText } from '../dom';
import type { Context } from '../view';

/** Value of the option for a text of the viewer's own. */
const kOwnText = '';

export class SweepFormView {
  readonly root: HTMLElement;
  private readonly title = h('h3', {});
  private readonly file = h('select', { 'data-role': 'sweep-file', 'aria-label': 'Sweep file' });
  private readonly fileLabel: HTMLElement;
  private readonly description = h('p', { class: 'sweep-form-description' });
  private readonly name = h('input', {
    type: 'text',
    'data-role': 'sweep-name',
    maxlength: 64,
    autocomplete: 'off',
    spellcheck: 'false',
  });
  private readonly jobs = h('input', {
    type: 'number',
    'data-role': 'sweep-jobs',
    min: 1,
    step: 1,
  });
  private readonly border = h('select', { 'data-role': 'sweep-border' });
  private readonly borderOf = h('select', { 'data-role': 'sweep-border-of' });
  private readonly borderOfLabel = h('label', { hidden: true }, 'Estimator', this.borderOf);
  private readonly text = h('textarea', {
    'data-role': 'sweep-text',
    spellcheck: 'false',
    'aria-label': 'Sweep as JSON',
  });
  private readonly cost = h('p', { class: 'sweep-cost', 'data-role': 'sweep-cost' });
  private readonly errors = h('ul', {
    class: 'sweep-errors',
    role: 'alert',
    'data-role': 'sweep-errors',
  });
  private readonly start = h('button', { class: 'primary', 'data-role': 'start-sweep' });
  private shown: SweepFormState | null = null;
  private loaded = -1;

  constructor(private readonly context: Context) {
    const { form } = context.sweeps;
    this.file.addEventListener('change', () => void form.chooseFile(this.file.value));
    this.name.addEventListener('input', () => form.setName(this.name.value));
    this.jobs.addEventListener('input', () => form.setJobs(this.jobs.valueAsNumber));
    this.border.addEventListener('change', () => form.setBorder({ axis: this.border.value }));
    this.borderOf.addEventListener('change', () =>
      form.setBorder({ estimator: this.borderOf.value }),
    );
    this.text.addEventListener('input', () => form.setText(this.text.value));
    this.start.addEventListener('click', () => void form.start());
    this.fileLabel = h('label', {}, 'Sweep file', this.file);
    this.root = h(
      'section',
      { class: 'sweep-form', hidden: true, 'data-changes': true, 'aria-label': 'Prepare a sweep' },
      this.title,
      h(
        'div',
        { class: 'sweep-form-fields' },
        this.fileLabel,
        h('label', {}, 'Name', this.name),
        h('label', { title: 'Flights at the same time' }, 'At a time', this.jobs),
        h(
          'label',
          { title: 'The border of survival needs only some cells: it is found by bisection' },
          'Fly',
          this.border,
        ),
        this.borderOfLabel,
      ),
      this.description,
      this.text,
      this.errors,
      h(
        'div',
        { class: 'sweep-form-end' },
        this.cost,
        h('button', { class: 'secondary', onclick: () => form.close() }, 'Close'),
        this.start,
      ),
    );
  }

  draw(): void {
    const { sweepPage: page } = this.context.store.state;
    const { form } = page;
    this.root.hidden = form === null;
    if (form === null) {
      this.shown = null;
      return;
    }
    const flying = page.sweeps?.find(({ here }) => here !== null)?.name ?? null;
    if (this.shown !== form || this.loaded !== form.loaded) this.load(form);
    this.drawFiles(form);
    this.drawBorder(form);
    this.drawErrors(form);
    this.name.disabled = form.changes !== null;
    this.jobs.max = String(form.files?.jobs.most ?? 1);
    if (document.activeElement !== this.jobs) this.jobs.value = String(form.jobs);
    setText(this.cost, costText(form, flying));
    setText(this.start, form.starting ? 'Starting' : form.changes === null ? 'Start' : 'Continue');
    this.start.disabled =
      form.cost === null || form.starting || form.name === '' || flying !== null;
  }

  private load(form: SweepFormState): void {
    this.shown = form;
    this.loaded = form.loaded;
    this.text.value = form.text;
    this.name.value = form.name;
    setText(this.title, form.changes === null ? 'New sweep' : `Extend ${form.changes}`);
  }

  private drawFiles({ changes, files, file }: SweepFormState): void {
    this.fileLabel.hidden = changes !== null;
    const list = files?.files ?? [];
    rebuild(this.file, JSON.stringify(list), () => [
      ...(list.length === 0 ? [h('option', { value: kOwnText }, 'The server has none')] : []),
      ...list.map(({ name, title, error }) =>
        h(
          'option',
          { value: name, disabled: error !== null, title: error ?? name },
          error === null ? title : `${title} (invalid)`,
        ),
      ),
    ]);
    this.file.disabled = list.length === 0;
    if (file !== null) this.file.value = file;
    const chosen = list.find(({ name }) => name === file);
    const extends_it =
      'Flights with the same settings are not flown again: add values to an axis, or repeats.';
    setText(this.description, changes === null ? (chosen?.description ?? '') : extends_it);
  }

  /** What was chosen stays while the text is checked again. */
  private drawBorder({ border, cost }: SweepFormState): void {
    if (cost !== null) {
      const { border_axes, estimator_names } = cost;
      rebuild(this.border, JSON.stringify(border_axes), () => [
        h('option', { value: '' }, 'every cell'),
        ...border_axes.map(({ name, label }) =>
          h('option', { value: name }, `the border along ${label}`),
        ),
      ]);
      rebuild(this.borderOf, JSON.stringify(estimator_names), () =>
        estimator_names.map((name) => h('option', { value: name }, name)),
      );
    }
    this.border.disabled = cost === null;
    this.border.value = border.axis;
    this.borderOfLabel.hidden = border.axis === '' || this.borderOf.options.length < 2;
    if (border.estimator !== '') this.borderOf.value = border.estimator;
  }

  private drawErrors({ errors }: SweepFormState): void {
    rebuild(this.errors, JSON.stringify(errors), () =>
      errors.map((error) =>
        h('li', {}, h('code', {}, error.field), error.field === '' ? '' : ': ', error.message),
      ),
    );
    this.text.classList.toggle('invalid', errors.some(inDocument));
    this.name.classList.toggle('invalid', !errors.every(inDocument));
  }
}

function inDocument({ field }: FieldError): boolean {
  return field !== 'name';
}

/** "6 cells × 4 estimators, at most 6 flights, about 2 min" */
function costText({ cost, checking, jobs, border }: SweepFormState, flying: string | null): string {
  if (checking) return 'Checking every cell';
  if (cost === null) return '';
  const { cells, estimators, flights, flight_s } = cost;
  const texts = [
    counted(cells, 'cell'),
    counted(estimators, 'estimator'),
    border.axis === '' ? `at most ${counted(flights, 'flight')}` : 'only the cells at the border',
    flight_s === null
      ? 'duration not known before the first flight'
      : `${border.axis === '' ? 'about' : 'less than'} ${formatDuration((flight_s * flights) / Math.min(jobs, flights))}`,
  ];
  if (flying !== null) texts.push(`${flying} is flying: one sweep flies at a time`);
  return texts.join(' · ');
}

function counted(number: number, what: string): string {
  return `${number} ${what}${number === 1 ? '' : 's'}`;
}
