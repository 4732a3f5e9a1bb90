// A study that the viewer prepares: of a run, or of a scenario with the launcher's changes.
import type { RestClient } from '../../connection/rest_client';
import { fieldErrorsOf } from '../../connection/rest_error';
import type { StudyClient } from '../../connection/study_client';
import type { FieldError } from '../../protocol/field_errors';
import type { Json, JsonObject, Run } from '../../protocol/rest_types';
import type { StudyKind } from '../../protocol/study_types';
import { withOverrides } from '../launch_form';
import { countedResults } from '../runs/counted_results';
import type { Store } from '../state';
import type { HuntField } from './hunt_fields';
import { huntFieldsOf } from './hunt_fields';

/** A scenario of the server with changes, or a whole document. */
export interface StudyScenario {
  scenario: string;
  overrides: Record<string, Json>;
  /** In place of scenario and overrides; null = none. */
  document: JsonObject | null;
  /** For people. */
  title: string;
}

/** One row of a hunt's form; texts as typed. */
export interface AxisRow {
  path: string;
  from: string;
  to: string;
  step: string;
}

export interface StudyFormState {
  kind: StudyKind;
  /** Of an explanation: id of the run. */
  run: string;
  /** A run that is not in the list, such as one of a sweep. */
  extraRun: Run | null;
  source: StudyScenario;
  /** What is flown; null until read. */
  document: JsonObject | null;
  estimator: string;
  /** Causes to be tried; none = those that are needed. */
  causes: ReadonlySet<string>;
  camera: string;
  map: boolean;
  all: boolean;
  /** Fields with numbers, as typed: '' = the default. */
  numbers: Record<string, string>;
  axes: AxisRow[];
  starting: boolean;
  errors: FieldError[];
}

const kNoScenario: StudyScenario = { scenario: '', overrides: {}, document: null, title: '' };

/** Fields with numbers of each kind, as the server names them. */
const kNumbers: Record<StudyKind, readonly string[]> = {
  explain: ['flights', 'jobs'],
  predict: ['rate_hz', 'map_km', 'cell_m', 'jobs'],
  hunt: ['flights', 'repeats', 'seed', 'position_rmse_limit_m', 'jobs'],
};

export class StudyForm {
  constructor(
    private readonly store: Store,
    private readonly client: StudyClient,
    private readonly rest: RestClient,
    /** Shows a study that has been started. */
    private readonly started: (name: string) => Promise<void>,
  ) {}

  /** @param run  null = the newest one that failed */
  openExplain(run: Run | null): void {
    const runs = this.store.state.runs ?? [];
    const chosen = run ?? runs.find((one) => failedEstimators(one).length > 0) ?? null;
    const form = this.begin('explain', kNoScenario);
    if (chosen !== null) {
      form.run = chosen.id;
      form.extraRun = runs.some(({ id }) => id === chosen.id) ? null : chosen;
      form.estimator = failedEstimators(chosen)[0] ?? '';
    }
    this.changed();
  }

  async openScenario(kind: 'predict' | 'hunt', source: StudyScenario): Promise<void> {
    const form = this.begin(kind, source);
    await this.readDocument(form);
  }

  close(): void {
    if (this.form === null) return;
    this.store.state.studyPage.form = null;
    this.changed();
  }

  chooseRun(id: string): void {
    const { form } = this;
    if (form === null) return;
    form.run = id;
    const run = this.runsOf(form).find((one) => one.id === id);
    form.estimator = run === undefined ? '' : (failedEstimators(run)[0] ?? '');
    this.withoutErrors('run', 'estimator');
  }

  /** A scenario of the server without changes. */
  async chooseScenario(name: string): Promise<void> {
    const { form } = this;
    if (form === null) return;
    form.source = plainScenario(name);
    await this.readDocument(form);
  }

  set(field: 'estimator' | 'camera', value: string): void {
    const { form } = this;
    if (form === null) return;
    form[field] = value;
    this.withoutErrors(field);
  }

  setNumber(field: string, text: string): void {
    const { form } = this;
    if (form === null) return;
    form.numbers = { ...form.numbers, [field]: text };
    this.withoutErrors(field);
  }

  setFlag(field: 'map' | 'all', value: boolean): void {
    const { form } = this;
    if (form === null) return;
    form[field] = value;
    this.changed();
  }

  setCause(name: string, chosen: boolean): void {
    const { form } = this;
    if (form === null) return;
    const causes = new Set(form.causes);
    if (chosen) causes.add(name);
    else causes.delete(name);
    form.causes = causes;
    this.changed();
  }

  setAxis(index: number, change: Partial<AxisRow>): void {
    const { form } = this;
    const row = form?.axes[index];
    if (form === null || row === undefined) return;
    const known = change.path === undefined ? undefined : this.fieldAt(form, change.path);
    form.axes = form.axes.map((one, i) =>
      i === index ? { ...one, ...change, ...(known === undefined ? {} : rowOf(known)) } : one,
    );
    form.errors = form.errors.filter(({ field }) => !field.startsWith('axes'));
    this.changed();
  }

  /** Another field of the scenario that has none yet. */
  addAxis(): void {
    const { form } = this;
    if (form === null || form.document === null) return;
    const next = huntFieldsOf(form.document).find(
      ({ path }) => !form.axes.some((axis) => axis.path === path),
    );
    const row = next === undefined ? { path: '', from: '', to: '', step: '' } : rowOf(next);
    form.axes = [...form.axes, row];
    this.changed();
  }

  removeAxis(index: number): void {
    const { form } = this;
    if (form === null) return;
    form.axes = form.axes.filter((_, i) => i !== index);
    form.errors = form.errors.filter(({ field }) => !field.startsWith('axes'));
    this.changed();
  }

  /** Runs that the form offers. */
  runsOf({ extraRun }: StudyFormState): Run[] {
    const listed = (this.store.state.runs ?? []).filter((run) => failedEstimators(run).length > 0);
    return extraRun === null ? listed : [extraRun, ...listed];
  }

  /** Whether there is something to be studied. */
  canStart(form: StudyFormState): boolean {
    if (form.starting) return false;
    if (form.kind !== 'explain') return form.document !== null;
    return this.runsOf(form).some(({ id }) => id === form.run);
  }

  /** @return whether the server makes it */
  async start(): Promise<boolean> {
    const { form } = this;
    if (form === null || form.starting) return false;
    const { request, errors } = requestOf(form);
    form.errors = errors;
    this.changed();
    if (errors.length > 0) return false;
    form.starting = true;
    this.changed();
    try {
      const { name } = await this.client.start(request);
      if (this.form === form) this.close();
      await this.started(name);
      return true;
    } catch (error) {
      form.errors = fieldErrorsOf(error);
      form.starting = false;
      this.changed();
      return false;
    }
  }

  private get form(): StudyFormState | null {
    return this.store.state.studyPage.form;
  }

  private fieldAt({ document }: StudyFormState, path: string): HuntField | undefined {
    return document === null ? undefined : huntFieldsOf(document).find((one) => one.path === path);
  }

  private begin(kind: StudyKind, source: StudyScenario): StudyFormState {
    const form: StudyFormState = {
      kind,
      run: '',
      extraRun: null,
      source,
      document: null,
      estimator: '',
      causes: new Set(),
      camera: '',
      map: true,
      all: false,
      numbers: {},
      axes: [],
      starting: false,
      errors: [],
    };
    this.store.state.studyPage.form = form;
    this.changed();
    return form;
  }

  /** Reads what is flown, for the names and the fields that it has. */
  private async readDocument(form: StudyFormState): Promise<void> {
    const { source } = form;
    form.document = null;
    form.errors = [];
    form.estimator = '';
    form.camera = '';
    this.changed();
    try {
      const base = source.document ?? (await this.rest.scenario(source.scenario));
      if (form.source !== source) return;
      form.document = withOverrides(base, source.overrides);
      const fields = huntFieldsOf(form.document);
      form.axes = fields.slice(0, 2).map(rowOf);
    } catch (error) {
      if (form.source === source) form.errors = fieldErrorsOf(error);
    }
    this.changed();
  }

  private withoutErrors(...fields: string[]): void {
    const { form } = this;
    if (form !== null) form.errors = form.errors.filter(({ field }) => !fields.includes(field));
    this.changed();
  }

  private changed(): void {
    this.store.change('studies');
  }
}

/** The estimators that a completed run has lost; none before it is scored. */
export function failedEstimators(run: Run): string[] {
  return countedResults(run)
    .filter(({ outcome }) => outcome !== 'COMPLETED')
    .map(({ estimator }) => estimator);
}

export function plainScenario(name: string): StudyScenario {
  return { scenario: name, overrides: {}, document: null, title: '' };
}

interface Asked {
  request: JsonObject;
  errors: FieldError[];
}

/** What the server is asked; limits of numbers are checked by the server. */
export function requestOf(form: StudyFormState): Asked {
  const errors: FieldError[] = [];
  const request: JsonObject = { kind: form.kind };
  for (const name of kNumbers[form.kind]) {
    const value = numberIn(form.numbers[name] ?? '', name, errors);
    if (value !== null) request[name] = value;
  }
  if (form.estimator !== '') request['estimator'] = form.estimator;
  if (form.kind === 'explain') {
    request['run'] = form.run;
    // Without a list the server tries properties of every flight only where they are needed.
    if (form.causes.size > 0) request['causes'] = [...form.causes];
    if (form.run === '') errors.push({ field: 'run', message: 'must be chosen' });
    return { request, errors };
  }
  const { scenario, overrides, document } = form.source;
  if (document === null) {
    request['scenario'] = scenario;
    if (Object.keys(overrides).length > 0) request['overrides'] = overrides;
  } else {
    request['document'] = withOverrides(document, overrides);
  }
  if (form.kind === 'predict') {
    if (form.camera !== '') request['camera'] = form.camera;
    request['map'] = form.map;
    return { request, errors };
  }
  if (form.all) request['all'] = true;
  request['axes'] = form.axes.map((row, i) => axisOf(row, i, form.document, errors));
  if (form.axes.length === 0) {
    errors.push({ field: 'axes', message: 'at least one field must be searched' });
  }
  return { request, errors };
}

function axisOf(
  row: AxisRow,
  index: number,
  document: JsonObject | null,
  errors: FieldError[],
): JsonObject {
  const path = row.path.trim();
  const axis: JsonObject = { path };
  const place = `axes.${index}`;
  if (path === '') errors.push({ field: `${place}.path`, message: 'must be the path of a field' });
  for (const name of ['from', 'to', 'step'] as const) {
    const value = numberIn(row[name], `${place}.${name}`, errors);
    if (value !== null) axis[name] = value;
    else if (name !== 'step' && row[name].trim() === '') {
      errors.push({ field: `${place}.${name}`, message: 'must be a number' });
    }
  }
  const known = huntFieldsOf(document ?? {}).find((one) => one.path === path);
  if (known !== undefined) {
    axis['label'] = known.label;
    if (known.unit !== '') axis['unit'] = known.unit;
  }
  return axis;
}

/** null for an empty text, and, with an error, for one that is no number. */
function numberIn(text: string, field: string, errors: FieldError[]): number | null {
  if (text.trim() === '') return null;
  const value = Number(text);
  if (Number.isFinite(value)) return value;
  errors.push({ field, message: 'must be a number' });
  return null;
}

function rowOf({ path, from, to }: HuntField): AxisRow {
  return { path, from: String(from), to: String(to), step: '' };
}
