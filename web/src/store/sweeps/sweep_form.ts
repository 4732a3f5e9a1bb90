// A sweep that the viewer prepares: its document, checked while typing, and what it costs.
import { fieldErrorsOf, RestError } from '../../connection/rest_error';
import type { SweepClient } from '../../connection/sweep_client';
import type { FieldError } from '../../protocol/field_errors';
import { readFieldErrors } from '../../protocol/field_errors';
import type { Json, JsonObject } from '../../protocol/rest_types';
import type { BorderSearch, SweepCheck, SweepFiles } from '../../protocol/sweep_types';
import type { Store } from '../state';

const kPause_ms = 500;
/** Status of a server that checks sweeps of others. */
const kBusy = 503;
const kRetry_ms = 2000;

export interface SweepFormState {
  /** The sweep whose document is changed; null = a new one. */
  changes: string | null;
  /** null until read. */
  files: SweepFiles | null;
  /** Sweep file that the text was taken from; null = none. */
  file: string | null;
  name: string;
  text: string;
  /** Increases when the text is replaced by other means than typing. */
  loaded: number;
  jobs: number;
  /** What is flown: the border along an axis; '' = every cell. The estimator: '' = the first. */
  border: BorderSearch;
  /** null while the text is checked, and if it has errors. */
  cost: SweepCheck | null;
  checking: boolean;
  starting: boolean;
  errors: FieldError[];
}

export class SweepForm {
  private check = new AbortController();

  constructor(
    private readonly store: Store,
    private readonly client: SweepClient,
    private readonly later: (callback: () => void, delay_ms: number) => void,
    /** Shows a sweep that has been started. */
    private readonly started: (name: string) => Promise<void>,
  ) {}

  /** A new sweep from the first of the server's sweep files. */
  async open(): Promise<void> {
    const form = this.begin(null);
    try {
      form.files = await this.client.files();
      form.jobs = form.files.jobs.default;
      const first = form.files.files.find(({ error }) => error === null);
      if (first !== undefined && this.form === form && form.text === '') {
        await this.readFile(form, first.name, '');
      }
    } catch (error) {
      form.errors = fieldErrorsOf(error);
    }
    this.changed();
  }

  /** The document of a sweep, to fly more of it. */
  async openSweep(name: string): Promise<void> {
    const form = this.begin(name);
    try {
      form.files = await this.client.files();
      form.jobs = form.files.jobs.default;
      const sought = this.store.state.sweepPage.sweeps?.find((one) => one.name === name)?.envelope;
      if (sought) form.border = { axis: sought.axis, estimator: sought.estimator };
      const document = await this.client.document(name);
      if (this.form === form && form.text === '') this.load(form, document);
    } catch (error) {
      form.errors = fieldErrorsOf(error);
    }
    this.changed();
  }

  close(): void {
    this.check.abort();
    this.store.state.sweepPage.form = null;
    this.changed();
  }

  async chooseFile(name: string): Promise<void> {
    const { form } = this;
    if (form !== null) await this.readFile(form, name, form.name);
  }

  /** What is typed while the file is read stays. @param replaced  the sweep's name that may be replaced */
  private async readFile(form: SweepFormState, name: string, replaced: string): Promise<void> {
    const { text } = form;
    form.file = name;
    this.changed();
    try {
      const document = await this.client.file(name);
      if (this.form !== form || form.file !== name) return;
      if (form.name === replaced) form.name = this.freeName(name);
      if (form.text === text) this.load(form, document);
      else form.file = null;
    } catch (error) {
      form.errors = fieldErrorsOf(error);
    }
    this.changed();
  }

  setName(name: string): void {
    const { form } = this;
    if (form === null) return;
    form.name = name;
    form.errors = form.errors.filter(({ field }) => field !== 'name');
    this.changed();
  }

  setJobs(jobs: number): void {
    const { form } = this;
    if (form === null || !Number.isInteger(jobs) || jobs < 1) return;
    form.jobs = Math.min(jobs, form.files?.jobs.most ?? jobs);
    this.changed();
  }

  setBorder(border: Partial<BorderSearch>): void {
    const { form } = this;
    if (form === null) return;
    form.border = { ...form.border, ...border };
    this.changed();
  }

  /** Checks the text after a pause in typing. */
  setText(text: string): void {
    const { form } = this;
    if (form === null) return;
    form.text = text;
    form.cost = null;
    const signal = this.newCheck();
    this.later(() => {
      if (!signal.aborted) void this.checkNow(form, signal);
    }, kPause_ms);
    this.changed();
  }

  /** @return whether the server flies it */
  async start(): Promise<boolean> {
    const { form } = this;
    if (form === null || form.starting) return false;
    const document = documentOf(form.text);
    if (!('value' in document)) {
      form.errors = [document];
      this.changed();
      return false;
    }
    form.starting = true;
    this.changed();
    try {
      const { name, changes } = form;
      const what = { document: document.value, jobs: form.jobs, ...borderOf(form) };
      if (changes === null) await this.client.start({ name, ...what });
      else await this.client.continue(changes, what);
      if (this.form === form) this.close();
      await this.started(changes ?? name);
      return true;
    } catch (error) {
      form.errors = fieldErrorsOf(error);
      form.starting = false;
      this.changed();
      return false;
    }
  }

  private get form(): SweepFormState | null {
    return this.store.state.sweepPage.form;
  }

  private begin(changes: string | null): SweepFormState {
    const form: SweepFormState = {
      changes,
      files: null,
      file: null,
      name: changes ?? '',
      text: '',
      loaded: 0,
      jobs: 1,
      border: { axis: '', estimator: '' },
      cost: null,
      checking: false,
      starting: false,
      errors: [],
    };
    this.store.state.sweepPage.form = form;
    this.changed();
    return form;
  }

  private load(form: SweepFormState, document: JsonObject): void {
    form.text = formatted(document);
    form.loaded += 1;
    form.errors = [];
    void this.checkNow(form, this.newCheck());
  }

  /** Ends the check in progress. */
  private newCheck(): AbortSignal {
    this.check.abort();
    this.check = new AbortController();
    return this.check.signal;
  }

  private async checkNow(form: SweepFormState, signal: AbortSignal): Promise<void> {
    form.cost = null;
    const document = documentOf(form.text);
    if (!('value' in document)) {
      form.errors = [document];
      form.checking = false;
      this.changed();
      return;
    }
    form.checking = true;
    this.changed();
    try {
      const check = await this.client.check(document.value, signal);
      if (signal.aborted) return;
      form.cost = check.valid ? check : null;
      if (check.valid) leaveUnknown(form, check);
      form.errors = check.valid ? [] : faultsOf(check);
    } catch (error) {
      if (signal.aborted) return;
      if (error instanceof RestError && error.status === kBusy) {
        this.later(() => {
          if (!signal.aborted) void this.checkNow(form, signal);
        }, kRetry_ms);
        return;
      }
      form.errors = fieldErrorsOf(error);
    }
    form.checking = false;
    this.changed();
  }

  private freeName(wanted: string): string {
    const taken = new Set((this.store.state.sweepPage.sweeps ?? []).map(({ name }) => name));
    let name = wanted;
    for (let i = 2; taken.has(name); i += 1) name = `${wanted}_${i}`;
    return name;
  }

  private changed(): void {
    this.store.change('sweeps');
  }
}

/** A changed document may lack what was chosen. */
function leaveUnknown({ border }: SweepFormState, check: SweepCheck): void {
  if (!check.border_axes.some(({ name }) => name === border.axis)) border.axis = '';
  if (!check.estimator_names.includes(border.estimator)) border.estimator = '';
}

function borderOf({ border, cost }: SweepFormState): { border?: BorderSearch } {
  if (border.axis === '') return {};
  const estimator = border.estimator === '' ? cost?.estimator_names[0] : border.estimator;
  return { border: { axis: border.axis, estimator: estimator ?? '' } };
}

/** Faults by field, or the message as a whole where no field is named. */
function faultsOf({ message, faults }: SweepCheck): FieldError[] {
  const fields = readFieldErrors(faults);
  return fields.length > 0 ? fields : [{ field: '', message }];
}

function documentOf(text: string): { value: JsonObject } | FieldError {
  try {
    const value = JSON.parse(text) as Json;
    if (typeof value === 'object' && value !== null && !Array.isArray(value)) return { value };
    return { field: '', message: 'The document must be a JSON object.' };
  } catch (error) {
    return { field: '', message: `No JSON: ${error instanceof Error ? error.message : ''}` };
  }
}

const kLine = 100;

/** JSON with short lists and objects in one line, as sweep files are written. */
export function formatted(value: Json, indent = ''): string {
  const flat = JSON.stringify(value, null, 1).replace(/\n\s*/g, ' ');
  if (typeof value !== 'object' || value === null) return flat;
  if (indent !== '' && indent.length + flat.length <= kLine) return flat;
  const inner = `${indent}  `;
  const lines = Array.isArray(value)
    ? value.map((one) => inner + formatted(one, inner))
    : Object.entries(value).map(
        ([name, one]) => `${inner}${JSON.stringify(name)}: ${formatted(one, inner)}`,
      );
  const [open, close] = Array.isArray(value) ? '[]' : '{}';
  return lines.length === 0 ? flat : `${open}\n${lines.join(',\n')}\n${indent}${close}`;
}
