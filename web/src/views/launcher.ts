// Selects a scenario, changes what is changed most often, starts a run.
import type { JsonObject, Run } from '../protocol/rest_types';
import { formatDate } from '../store/format';
import { fieldOfError, fieldsOf, fieldText, kUsualScenario } from '../store/launch_form';
import type { FieldSpec } from '../store/launch_form';
import { draftOf } from '../store/scenario/draft';
import type { Topic } from '../store/state';
import { viewerNote, wordsFor } from './access';
import { h, rebuild, setAttribute, setText } from './dom';
import { makePanel } from './panel';
import { prepareStudy } from './studies/prepare_study';
import type { Context, View } from './view';

const kEditLabel = 'Edit scenario';
const kLogsHint = 'Flight logs: look at them, upload them, fly them';
const kLogsHintOfViewer = 'Flight logs: look at what they contain';
/** Value of the option of a run that is flown again: no scenario's name. */
const kRepeated = '';

interface Field {
  spec: FieldSpec;
  row: HTMLElement;
  error: HTMLElement;
  /** Shows a text, unless the viewer is typing here. */
  fill: (text: string) => void;
}

export class Launcher implements View {
  readonly root: HTMLElement;
  private readonly picker = h('select', { id: 'scenario', 'aria-label': 'Scenario' });
  private readonly description = h('p', { class: 'scenario-description' });
  private readonly fieldArea = h('div', { class: 'fields' });
  private readonly errors = h('div', { class: 'form-errors', role: 'alert' });
  private readonly editor = h(
    'button',
    {
      class: 'secondary',
      type: 'button',
      'data-role': 'edit-json',
      title:
        'All settings of the scenario: camera, estimators and their parameters, world, faults, ...',
    },
    kEditLabel,
  );
  private readonly button = h(
    'button',
    { class: 'primary', type: 'submit', 'data-changes': true },
    'Launch flight',
  );
  private readonly logs = h(
    'button',
    {
      class: 'tab',
      type: 'button',
      'data-role': 'open-logs',
      onclick: () => void this.context.logs.open(),
    },
    ...wordsFor('Fly a log', 'Flight logs'),
  );
  private fields: Field[] = [];
  private documentShown: object | null = null;

  constructor(private readonly context: Context) {
    const panel = makePanel('launcher', 'Launch');
    this.root = panel.root;
    this.picker.addEventListener(
      'change',
      () => void context.catalogue.selectScenario(this.picker.value),
    );
    const form = h(
      'form',
      {
        class: 'launch-form',
        novalidate: true,
        onsubmit: (event: SubmitEvent) => {
          event.preventDefault();
          void context.catalogue.launch();
        },
      },
      this.picker,
      this.description,
      this.fieldArea,
      this.errors,
      h(
        'div',
        { class: 'launch-buttons' },
        this.button,
        this.editor,
        this.studyButtons(),
        viewerNote(),
      ),
    );
    this.keepRoom();
    this.editor.addEventListener('click', () => void context.scenarios.openEditor());
    panel.body.append(form);
    panel.tools.append(
      this.logs,
      h(
        'button',
        {
          class: 'tab',
          type: 'button',
          'data-role': 'open-connect',
          'data-changes': true,
          title: 'Fly what an autopilot reports: simulated or real, by its address',
          onclick: () => this.context.connect.open(),
        },
        'Connect',
      ),
    );
  }

  private studyButtons(): HTMLElement {
    return h(
      'div',
      { class: 'launch-studies', 'data-changes': true },
      this.studyButton('predict', 'Predict risk', 'Where an estimator is likely to be lost'),
      this.studyButton('hunt', 'Hunt the worst flight', 'Search within limits of some fields'),
    );
  }

  /** Prepares a study of the scenario with the form's values. */
  private studyButton(kind: 'predict' | 'hunt', label: string, title: string): HTMLElement {
    const role = `open-${kind}`;
    const button = h(
      'button',
      { class: 'secondary', type: 'button', 'data-role': role, title },
      label,
    );
    button.addEventListener('click', () => prepareStudy(this.context, kind));
    return button;
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('lists') || changed.has('launch')) this.updatePicker();
    if (!changed.has('launch') && !changed.has('connection')) return;
    const { state } = this.context.store;
    setAttribute(this.logs, 'title', state.mayChange ? kLogsHint : kLogsHintOfViewer);
    const { scenarioDocument: base, scenarioEdits } = state;
    if (base !== this.documentShown) this.buildFields();
    if (base !== null) this.fillFields(draftOf(base, scenarioEdits).document);
    this.updateErrors();
    this.button.disabled =
      state.launching || state.scenarioDocument === null || state.connection.status !== 'open';
    const { size } = state.scenarioEdits;
    setText(this.editor, size === 0 ? kEditLabel : `${kEditLabel} (${size})`);
    this.editor.disabled = state.scenarioDocument === null;
    setText(this.button, state.launching ? 'Launching' : 'Launch flight');
  }

  private updatePicker(): void {
    const { scenarios, scenarioName, repeatedRun } = this.context.store.state;
    rebuild(this.picker, JSON.stringify([scenarios, repeatedRun?.id ?? null]), () => [
      ...repeatedOption(repeatedRun),
      ...(scenarios ?? []).map(({ name, title, error, saved }) =>
        h(
          'option',
          { value: name, title: error ?? name },
          `${saved ? `${title} · ${name}` : title}${error === null ? '' : ' (unavailable)'}`,
        ),
      ),
    ]);
    if (repeatedRun !== null) this.picker.value = kRepeated;
    else if (scenarioName !== null) this.picker.value = scenarioName;
    this.picker.disabled = scenarios === null || scenarios.length === 0;
    const entry = scenarios?.find(({ name }) => name === scenarioName);
    const empty =
      scenarios?.length === 0 ? 'The server has no scenarios.' : 'Reading the scenarios';
    const description =
      repeatedRun === null
        ? entry?.description || (entry && 'No description.')
        : `All settings of the run of ${formatDate(repeatedRun.created_utc)}. Change what is to differ.`;
    setText(this.description, description ?? empty);
    this.description.title = description ?? '';
  }

  /** For the fields, before the scenario is read: the buttons below do not jump. */
  private keepRoom(): void {
    const fields = fieldsOf(kUsualScenario).map((spec) => makeField(spec, () => undefined));
    for (const { fill } of fields) fill('');
    this.fieldArea.append(...fields.map(({ row }) => row));
    this.fieldArea.style.visibility = 'hidden';
  }

  private buildFields(): void {
    const document = this.context.store.state.scenarioDocument;
    this.documentShown = document;
    const { scenarioName: name, repeatedRun } = this.context.store.state;
    setAttribute(this.fieldArea, 'data-scenario', document === null ? null : name);
    setAttribute(this.fieldArea, 'data-repeats', repeatedRun?.id ?? null);
    if (document === null) {
      this.fields = [];
    } else {
      const { scenarios } = this.context;
      this.fields = fieldsOf(document).map((spec) =>
        makeField(spec, (text) => scenarios.setField(spec, text)),
      );
      this.fieldArea.replaceChildren(...this.fields.flatMap(({ row, error }) => [row, error]));
      this.fieldArea.style.visibility = '';
    }
  }

  private fillFields(document: JsonObject): void {
    for (const { spec, fill } of this.fields) fill(fieldText(document, spec));
  }

  private updateErrors(): void {
    const { launchErrors } = this.context.store.state;
    const specs = this.fields.map(({ spec }) => spec);
    for (const { spec, row, error } of this.fields) {
      const own = launchErrors.filter((entry) => fieldOfError(specs, entry) === spec);
      setText(error, own.map(({ message }) => message).join(' '));
      error.hidden = own.length === 0;
      row.classList.toggle('invalid', own.length > 0);
    }
    const rest = launchErrors.filter((entry) => fieldOfError(specs, entry) === null);
    setText(
      this.errors,
      rest
        .map(({ field, message }) => (field === '' ? message : `${field}: ${message}`))
        .join('\n'),
    );
    this.errors.hidden = rest.length === 0;
  }
}

function repeatedOption(run: Run | null): HTMLElement[] {
  if (run === null) return [];
  return [h('option', { value: kRepeated }, `Again: ${run.title || run.scenario}`)];
}

type OnText = (text: string) => void;

function makeField(spec: FieldSpec, onText: OnText): Field {
  const id = `field-${spec.path}`;
  const error = h('div', { class: 'field-error', hidden: true, 'data-error-of': spec.path });
  const { control, fill } =
    spec.kind === 'estimators' ? estimatorControl(spec, onText) : valueControl(spec, id, onText);
  const label =
    spec.kind === 'estimators'
      ? h('span', { class: 'label' }, spec.label)
      : h('label', { for: id }, spec.label);
  const row = h('div', { class: `field ${spec.kind}`, title: spec.hint }, label, control);
  if (spec.kind === 'number') row.append(h('span', { class: 'unit' }, spec.unit));
  return { spec, row, error, fill };
}

function valueControl(spec: FieldSpec, id: string, onText: OnText) {
  if (spec.kind === 'choice') {
    const select = h('select', { id });
    select.addEventListener('change', () => onText(select.value));
    const fill = (text: string) => {
      const choices = [...(spec.choices ?? [])];
      if (!choices.some(({ value }) => value === text)) choices.push({ value: text, label: text });
      rebuild(select, JSON.stringify(choices), () =>
        choices.map(({ value, label }) => h('option', { value }, label)),
      );
      select.value = text;
    };
    return { control: select, fill };
  }
  const input = h('input', {
    id,
    type: spec.kind === 'text' ? 'text' : 'number',
    step: spec.kind === 'text' ? undefined : 'any',
    placeholder: spec.empty ?? '',
    autocomplete: 'off',
  });
  input.addEventListener('input', () =>
    onText(input.validity.badInput ? 'not a number' : input.value),
  );
  const fill = (text: string) => {
    if (document.activeElement !== input && input.value !== text) input.value = text;
  };
  return { control: input, fill };
}

function estimatorControl(spec: FieldSpec, onText: OnText) {
  const control = h('div', { class: 'checks' });
  let boxes: HTMLInputElement[] = [];
  let chosen: string[] = [];
  // Of the scenario, and of the editor; they stay when they are not chosen any more.
  const seen = new Map((spec.choices ?? []).map(({ value, label }) => [value, label]));
  const choose = () => {
    const ticked = boxes.filter(({ checked }) => checked).map(({ value }) => value);
    const kept = chosen.filter((name) => ticked.includes(name));
    onText([...kept, ...ticked.filter((name) => !chosen.includes(name))].join(','));
  };
  const fill = (text: string) => {
    chosen = text.split(',').filter((name) => name !== '');
    for (const name of chosen) if (!seen.has(name)) seen.set(name, name);
    rebuild(control, JSON.stringify([...seen]), () => {
      boxes = [...seen.keys()].map((value) =>
        h('input', { type: 'checkbox', value, 'data-estimator': value, onchange: choose }),
      );
      return boxes.map((box) => h('label', { class: 'check' }, box, seen.get(box.value) ?? ''));
    });
    for (const box of boxes) box.checked = chosen.includes(box.value);
  };
  return { control, fill };
}
