// Prepares a study: the run or the scenario, and its options.
import type { StudyLimits, StudyRange } from '../../protocol/study_types';
import { namesAt } from '../../store/studies/hunt_fields';
import type { StudyFormState } from '../../store/studies/study_form';
import { failedEstimators } from '../../store/studies/study_form';
import { formatDate } from '../../store/format';
import { plainWords } from '../../store/studies/study_words';
import { h, rebuild, setText } from '../dom';
import type { Context } from '../view';
import { huntAxes } from './hunt_axes';

const kTitles = {
  explain: 'Explain why an estimator failed',
  predict: 'Predict where an estimator is likely to be lost',
  hunt: 'Hunt the worst flight',
} as const;

const kNotes = {
  explain:
    'The critical part of the flight is flown again and again, each time with exactly one cause changed.',
  predict:
    'Nothing is flown: imagery, elevation and mission show how a camera would see each part of the flight.',
  hunt: 'Flights within the limits are chosen by how well those before were survived, until one fails.',
} as const;

/** Value of the option for the launcher's scenario with its changes. */
const kAsInLaunch = '';

export class StudyFormView {
  readonly root: HTMLElement;
  private readonly title = h('h3', {});
  private readonly note = h('p', { class: 'sweep-form-description' });
  private readonly fields = h('div', { class: 'study-form-fields' });
  private readonly errors = h('ul', {
    class: 'sweep-errors',
    role: 'alert',
    'data-role': 'study-errors',
  });
  private readonly start = h('button', { class: 'primary', 'data-role': 'start-study' });

  constructor(private readonly context: Context) {
    const { form } = context.studies;
    this.start.addEventListener('click', () => void form.start());
    this.root = h(
      'section',
      {
        class: 'sweep-form study-form',
        hidden: true,
        'data-changes': true,
        'aria-label': 'Prepare a study',
        onkeydown: (event: KeyboardEvent) => {
          if (event.key !== 'Escape') return;
          event.stopPropagation();
          form.close();
        },
      },
      this.title,
      this.note,
      this.fields,
      this.errors,
      h(
        'div',
        { class: 'sweep-form-end' },
        h('span', { class: 'sweep-cost' }),
        h('button', { class: 'secondary', onclick: () => form.close() }, 'Close'),
        this.start,
      ),
    );
  }

  draw(): void {
    const { form, limits } = this.context.store.state.studyPage;
    this.root.hidden = form === null;
    if (form === null) {
      rebuild(this.fields, '', () => []);
      return;
    }
    setText(this.title, kTitles[form.kind]);
    setText(this.note, kNotes[form.kind]);
    // Typed texts are not in the key: the fields that have the focus stay.
    const paths = form.axes.map(({ path }) => path);
    const { kind, run, source, document, estimator, camera } = form;
    const known = [kind, run, source, document !== null, estimator, camera, form.map];
    // What a kind does not offer may change without its fields.
    const offered =
      kind === 'explain'
        ? this.context.studies.form.runsOf(form).map(({ id }) => id)
        : this.context.store.state.scenarios?.map(({ name }) => name);
    rebuild(this.fields, JSON.stringify([known, paths, offered, limits !== null]), () =>
      this.fieldsOf(form, limits),
    );
    this.drawErrors(form);
    setText(this.start, form.starting ? 'Starting' : 'Start');
    this.start.disabled = !this.context.studies.form.canStart(form);
  }

  private fieldsOf(form: StudyFormState, limits: StudyLimits | null): HTMLElement[] {
    switch (form.kind) {
      case 'explain':
        return this.explainFields(form, limits);
      case 'predict':
        return this.predictFields(form, limits);
      case 'hunt':
        return this.huntFields(form, limits);
    }
  }

  // ---- explain ---------------------------------------------------------------------------------

  private explainFields(form: StudyFormState, limits: StudyLimits | null): HTMLElement[] {
    const { form: actions } = this.context.studies;
    const runs = actions.runsOf(form);
    const chosen = runs.find(({ id }) => id === form.run);
    if (runs.length === 0) {
      return [h('p', { class: 'sweep-form-description' }, 'No estimator has failed in a run yet.')];
    }
    const boxes = (limits?.explain.causes ?? []).map(({ name, words }) =>
      check(plainWords(words), `cause-${name}`, form.causes.has(name), (ticked) =>
        actions.setCause(name, ticked),
      ),
    );
    return [
      row(
        labelled(
          'Run',
          select(
            'study-run',
            runs.map(({ id, title, scenario, created_utc }) => [
              id,
              `${title || scenario}, ${formatDate(created_utc)}`,
            ]),
            form.run,
            (id) => actions.chooseRun(id),
          ),
        ),
        labelled(
          'Estimator',
          select(
            'study-estimator',
            (chosen === undefined ? [] : failedEstimators(chosen)).map((name) => [name, name]),
            form.estimator,
            (name) => actions.set('estimator', name),
          ),
        ),
      ),
      row(
        this.number(form, 'flights', 'Flights at most', limits?.explain.flights),
        this.number(form, 'jobs', 'At a time', limits?.jobs),
      ),
      h(
        'fieldset',
        { class: 'study-causes' },
        h('legend', {}, 'Only these causes (none ticked: all that are needed)'),
        ...boxes,
      ),
    ];
  }

  // ---- predict ---------------------------------------------------------------------------------

  private predictFields(form: StudyFormState, limits: StudyLimits | null): HTMLElement[] {
    const { form: actions } = this.context.studies;
    const cameras = namesAt(form.document, 'cameras');
    return [
      row(
        this.scenario(form),
        ...(cameras.length < 2
          ? []
          : [
              labelled(
                'Camera',
                select(
                  'study-camera',
                  cameras.map((name) => [name, name]),
                  form.camera,
                  (name) => actions.set('camera', name),
                ),
              ),
            ]),
      ),
      row(
        this.number(form, 'rate_hz', 'Instants', limits?.predict.rate_hz, 'per s'),
        check('Map of risk', 'study-map', form.map, (ticked) => actions.setFlag('map', ticked)),
        ...(form.map
          ? [
              this.number(form, 'map_km', 'Side of the map', limits?.predict.map_km, 'km'),
              this.number(form, 'cell_m', 'Cells', limits?.predict.cell_m, 'm'),
            ]
          : []),
        this.number(form, 'jobs', 'Threads', limits?.jobs),
      ),
    ];
  }

  // ---- hunt ------------------------------------------------------------------------------------

  private huntFields(form: StudyFormState, limits: StudyLimits | null): HTMLElement[] {
    const { form: actions } = this.context.studies;
    const estimators = namesAt(form.document, 'estimators');
    const most = limits?.hunt.axes.most ?? 1;
    return [
      row(
        this.scenario(form),
        labelled(
          'Estimator',
          select(
            'study-estimator',
            estimators.map((name) => [name, name]),
            form.estimator,
            (name) => actions.set('estimator', name),
          ),
        ),
      ),
      huntAxes(this.context, form, most),
      row(
        this.number(form, 'flights', 'Flights at most', limits?.hunt.flights),
        this.number(form, 'repeats', 'Seeds of each point', limits?.hunt.repeats),
        this.number(form, 'seed', 'Seed of the search', limits?.hunt.seed),
        this.number(form, 'position_rmse_limit_m', 'Largest error', undefined, 'm'),
        this.number(form, 'jobs', 'At a time', limits?.jobs),
        check('Go on after the first failure', 'study-all', form.all, (ticked) =>
          actions.setFlag('all', ticked),
        ),
      ),
    ];
  }

  // ---- parts -----------------------------------------------------------------------------------

  private scenario({ source }: StudyFormState): HTMLElement {
    const { studies, store } = this.context;
    const changes = Object.keys(source.overrides).length;
    const asInLaunch = source.document !== null || changes > 0;
    const count = changes === 0 ? '' : `, ${changes} ${changes === 1 ? 'change' : 'changes'}`;
    const own: [string, string][] = asInLaunch
      ? [[kAsInLaunch, `As in Launch: ${source.title}${count}`]]
      : [];
    const listed = (store.state.scenarios ?? [])
      .filter(({ error }) => error === null)
      .map(({ name, title }): [string, string] => [name, title]);
    return labelled(
      'Scenario',
      select(
        'study-scenario',
        [...own, ...listed],
        asInLaunch ? kAsInLaunch : source.scenario,
        (name) => void studies.form.chooseScenario(name),
      ),
    );
  }

  private number(
    form: StudyFormState,
    name: string,
    label: string,
    range?: StudyRange,
    unit = '',
  ): HTMLElement {
    const input = h('input', {
      type: 'text',
      inputmode: 'decimal',
      class: 'study-number',
      value: form.numbers[name] ?? '',
      placeholder: range === undefined ? 'none' : String(range.default),
      title: range === undefined ? '' : `${range.least} to ${range.most}`,
      'data-role': `study-${name}`,
      autocomplete: 'off',
    });
    input.addEventListener('input', () => this.context.studies.form.setNumber(name, input.value));
    const field = labelled(label, input);
    if (unit !== '') field.append(h('span', { class: 'unit' }, unit));
    return field;
  }

  private drawErrors({ errors }: StudyFormState): void {
    rebuild(this.errors, JSON.stringify(errors), () =>
      errors.map((error) =>
        h('li', {}, h('code', {}, error.field), error.field === '' ? '' : ': ', error.message),
      ),
    );
    for (const input of this.fields.querySelectorAll<HTMLElement>('[data-role]')) {
      const role = input.dataset['role'] ?? '';
      const field = role.replace(/^axis-(\d+)-/, 'axes.$1.').replace(/^study-/, '');
      input.classList.toggle(
        'invalid',
        errors.some((error) => error.field === field),
      );
    }
  }
}

function row(...children: HTMLElement[]): HTMLElement {
  return h('div', { class: 'sweep-form-fields' }, ...children);
}

function labelled(text: string, control: HTMLElement): HTMLElement {
  return h('label', {}, text, control);
}

function check(
  text: string,
  role: string,
  checked: boolean,
  change: (checked: boolean) => void,
): HTMLElement {
  const box = h('input', { type: 'checkbox', checked, 'data-role': role });
  box.addEventListener('change', () => change(box.checked));
  return h('label', { class: 'check' }, box, text);
}

function select(
  role: string,
  options: readonly (readonly [string, string])[],
  chosen: string,
  choose: (value: string) => void,
): HTMLSelectElement {
  const control = h(
    'select',
    { 'data-role': role },
    ...options.map(([value, label]) => h('option', { value, selected: value === chosen }, label)),
  );
  control.addEventListener('change', () => choose(control.value));
  return control;
}
