// The launcher's fields: the values of a scenario that are changed most often.
import type { FieldError } from '../protocol/field_errors';
import type { Json, JsonObject } from '../protocol/rest_types';
import { valueIn, withValue } from './scenario/draft';
import { isObject } from './scenario/schema_node';

export interface FieldSpec {
  /** Dotted path in the scenario document. */
  path: string;
  label: string;
  unit: string;
  kind: 'number' | 'choice' | 'estimators' | 'text';
  choices?: readonly { value: string; label: string }[];
  step?: number;
  /** The field is omitted if the document has no value at this path. */
  needs?: string;
  /** May be empty: the value at this path is then removed. */
  removes?: string;
  /** What an empty field means, shown in it. */
  empty?: string;
  hint: string;
}

/** Types of estimators that need nothing but their name. */
export const kEstimatorChoices = [
  { value: 'feature', label: 'Feature' },
  { value: 'baseline_homography', label: 'Homography' },
  { value: 'baseline_dead_reckoning', label: 'Dead reckoning' },
  { value: 'baseline_hold', label: 'Hold' },
  { value: 'perfect', label: 'Perfect' },
  { value: 'drifting', label: 'Drifting' },
] as const;

const kCourse = 'flight.course';

export const kFields: readonly FieldSpec[] = [
  {
    path: `${kCourse}.airspeed_m_s`,
    label: 'Airspeed',
    unit: 'm/s',
    kind: 'number',
    step: 1,
    needs: kCourse,
    hint: 'True airspeed',
  },
  {
    path: `${kCourse}.roll_rate_max_deg_s`,
    label: 'Max roll rate',
    unit: 'deg/s',
    kind: 'number',
    step: 5,
    needs: kCourse,
    hint: 'Reached at each reversal',
  },
  {
    path: `${kCourse}.height_agl_m`,
    label: 'Height AGL',
    unit: 'm',
    kind: 'number',
    step: 10,
    needs: kCourse,
    hint: 'Above the ground',
  },
  {
    path: `${kCourse}.bank_max_deg`,
    label: 'Bank limit',
    unit: 'deg',
    kind: 'number',
    step: 5,
    needs: kCourse,
    hint: 'Largest bank angle',
  },
  {
    path: `${kCourse}.dynamics`,
    label: 'Aircraft',
    unit: '',
    kind: 'choice',
    needs: `${kCourse}.dynamics`,
    hint: 'Coordinated turns in still air, or an airframe with its autopilot: foam trainer 8 to 19, Cub 10 to 37, Aerosonde 16 to 32 m/s',
    choices: [
      { value: 'coordinated', label: 'Coordinated' },
      { value: 'foam_trainer', label: 'Foam trainer' },
      { value: 'piper_cub_third', label: 'Piper Cub, 1/3' },
      { value: 'aerosonde', label: 'Aerosonde' },
    ],
  },
  {
    path: `${kCourse}.turbulence`,
    label: 'Turbulence',
    unit: '',
    kind: 'choice',
    needs: `${kCourse}.turbulence`,
    hint: 'Dryden turbulence of MIL-F-8785C; needs an airframe',
    choices: [
      { value: 'none', label: 'None' },
      { value: 'light', label: 'Light' },
      { value: 'moderate', label: 'Moderate' },
      { value: 'severe', label: 'Severe' },
    ],
  },
  {
    path: `${kCourse}.wind.speed_m_s`,
    label: 'Wind',
    unit: 'm/s',
    kind: 'number',
    step: 1,
    needs: kCourse,
    removes: `${kCourse}.wind`,
    empty: 'calm',
    hint: 'Steady wind; needs an airframe',
  },
  {
    path: `${kCourse}.wind.from_deg`,
    label: 'Wind from',
    unit: 'deg',
    kind: 'number',
    step: 10,
    needs: kCourse,
    removes: `${kCourse}.wind.from_deg`,
    empty: '270',
    hint: 'Clockwise from north: 270 is wind from the west',
  },
  {
    path: 'flight.mavlink.link',
    label: 'Vehicle',
    unit: '',
    kind: 'text',
    needs: 'flight.mavlink',
    hint: 'Link to the autopilot: udp-listen:HOST:PORT, udp:, tcp:, tcp-listen:, serial:DEVICE:BAUD. The server opens only those of its --allow-link',
  },
  {
    path: 'seed',
    label: 'Seed',
    unit: '',
    kind: 'number',
    step: 1,
    hint: 'Seed of all random effects except the world',
  },
  {
    path: 'world.builtin.seed',
    label: 'World seed',
    unit: '',
    kind: 'number',
    step: 1,
    needs: 'world.builtin',
    hint: 'Seed of the built-in landscape',
  },
  {
    path: 'duration_s',
    label: 'Duration',
    unit: 's',
    kind: 'number',
    step: 5,
    removes: 'duration_s',
    empty: 'all',
    hint: 'Ends the flight early; empty = the whole flight',
  },
  {
    path: 'pacing',
    label: 'Pacing',
    unit: '',
    kind: 'choice',
    hint: 'Lockstep waits for the estimators; real time drops frames',
    choices: [
      { value: 'lockstep', label: 'Lockstep' },
      { value: 'real_time', label: 'Real time' },
    ],
  },
  {
    path: 'estimators',
    label: 'Estimators',
    unit: '',
    kind: 'estimators',
    hint: 'None = camera and truth only',
    choices: kEstimatorChoices,
  },
];

/** Has the fields of the scenario that is shown first. */
export const kUsualScenario: JsonObject = {
  world: { builtin: {} },
  flight: { course: {} },
};

export function fieldsOf(document: JsonObject): FieldSpec[] {
  return kFields.filter(
    ({ needs }) => needs === undefined || valueIn(document, needs) !== undefined,
  );
}

/**
 * The text that a field shows for a document: a number, a choice, or comma-separated estimator
 * names.
 */
export function fieldText(document: JsonObject, field: FieldSpec): string {
  const value = valueIn(document, field.path);
  if (field.kind === 'estimators') return estimatorsOf(value).map(nameOf).join(',');
  return typeof value === 'number' || typeof value === 'string' ? String(value) : '';
}

/**
 * A document with a field's text as its value; text that is no number stays text, so that its error
 * can be shown.
 * @param base  the document without changes, whose estimators keep their settings
 */
export function withFieldText(
  document: JsonObject,
  base: JsonObject,
  field: FieldSpec,
  typed: string,
): JsonObject {
  const text = typed.trim();
  if (text === fieldText(document, field)) return document;
  if (field.kind === 'estimators') {
    const known = [document, base].flatMap((one) => estimatorsOf(valueIn(one, field.path)));
    return withValue(document, field.path, estimatorList(text, known));
  }
  if (text === '' && field.removes !== undefined) {
    return withValue(document, field.removes, undefined);
  }
  const number = field.kind === 'number' && text !== '' ? Number(text) : NaN;
  return withValue(document, field.path, Number.isFinite(number) ? number : text);
}

/** A document with other values, as the server applies overrides. */
export function withOverrides(document: JsonObject, overrides: Record<string, Json>): JsonObject {
  const changed = structuredClone(document);
  for (const [path, value] of Object.entries(overrides)) {
    const parts = path.split('.');
    const last = parts.pop() ?? '';
    let place = changed;
    for (const part of parts) {
      const inner = place[part];
      const next = isObject(inner) ? inner : {};
      place[part] = next;
      place = next;
    }
    place[last] = value;
  }
  return changed;
}

/**
 * The field to which an error belongs: the one with the same path, or with a path that contains it.
 */
export function fieldOfError(fields: readonly FieldSpec[], error: FieldError): FieldSpec | null {
  return (
    fields.find(({ path }) => error.field === path || error.field.startsWith(`${path}.`)) ?? null
  );
}

function estimatorsOf(value: Json | undefined): JsonObject[] {
  if (!Array.isArray(value)) return [];
  return value.filter(isObject);
}

function nameOf(estimator: JsonObject): string {
  const name = estimator['name'];
  return typeof name === 'string' ? name : '';
}

/** Keeps known estimators unchanged; others are native ones, named after their type. */
function estimatorList(text: string, known: JsonObject[]): Json[] {
  return text
    .split(',')
    .filter((name) => name !== '')
    .map((name) => known.find((entry) => nameOf(entry) === name) ?? { name, type: name });
}
