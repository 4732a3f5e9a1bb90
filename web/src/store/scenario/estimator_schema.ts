// What the schema leaves open of an estimator: the parameters of the native types, and which fields
// belong to which type. The tables are those of docs/SCENARIOS.md.
import type { Json, JsonObject } from '../../protocol/rest_types';
import { isObject, objectAt, objectOf, textOf } from './schema_node';

const integer = (minimum: number, maximum: number, usual: number, description: string) => ({
  type: 'integer',
  minimum,
  maximum,
  default: usual,
  description,
});
const on = (description: string) => ({ type: 'boolean', default: true, description });

const kFeature: JsonObject = {
  features: integer(100, 20000, 2000, 'Corners per image.'),
  levels: integer(1, 16, 8, "Levels of the corners' pyramid."),
  scale_factor: {
    type: 'number',
    exclusiveMinimum: 1,
    maximum: 2,
    default: 1.2,
    description: 'Between two levels of the pyramid.',
  },
  ini_fast_threshold: integer(1, 100, 20, 'Grey levels, first search of a cell for corners.'),
  min_fast_threshold: integer(1, 100, 7, 'Grey levels, second search of a cell without corners.'),
  rotation_compensation: on('The search starts where the last rotation predicts the point.'),
  planar_start: on("The first map may come from a plane's homography."),
  low_texture: on('Fainter corners and coarser patches where nothing else is found.'),
  reject_saturated: on('Does not search in overexposed areas.'),
  initial_height_m: {
    type: 'number',
    minimum: 0,
    maximum: 20000,
    default: 0,
    description:
      'Height above ground at the first map, whose poses are then in metres. 0 = not known.',
  },
  threads: {
    type: 'integer',
    minimum: 1,
    maximum: 2,
    description: '2 = mapping in parallel; results then differ. Default: lockstep 1, real time 2.',
  },
  seed: {
    type: 'integer',
    minimum: 0,
    maximum: 9007199254740991,
    description: "Of its random numbers. Default: the scenario's.",
  },
};

const kHomography: JsonObject = {
  features: integer(20, 5000, 400, 'Corners of a reference image.'),
  reference_px: {
    type: 'number',
    exclusiveMinimum: 0,
    default: 60,
    description: 'Median motion after which a new reference is taken.',
  },
};

const kTruth: JsonObject = {
  scale: {
    type: 'number',
    exclusiveMinimum: 0,
    default: 0.37,
    description: "The estimator's units per metre.",
  },
  drift: {
    type: 'number',
    exclusiveMinimum: -1,
    maximum: 1,
    default: 0,
    description: 'Position error as a fraction of the path.',
  },
  scene_depth_m: {
    type: 'number',
    minimum: 0,
    description: 'Reported in place of the true depth of each image; 0 = none.',
  },
};

/** Parameters of the types that have fixed ones; programs, LCM and ROS accept any. */
export const kParameters: Record<string, JsonObject> = {
  feature: kFeature,
  baseline_hold: {},
  baseline_homography: kHomography,
  baseline_dead_reckoning: {},
  perfect: kTruth,
  drifting: kTruth,
};

/** Fields that only some types have. */
const kOnly: Record<string, readonly string[]> = {
  command: ['process'],
  listen: ['process'],
  memory_limit_mb: ['process'],
  start_timeout_s: ['process', 'lcm', 'ros1'],
  answer_timeout_s: ['process', 'lcm', 'ros1'],
  lcm: ['lcm'],
  ros1: ['ros1'],
};

/** The schema with one condition for each type of estimator. */
export function withEstimatorTypes(schema: JsonObject): JsonObject {
  const definitions = objectAt(schema, '$defs');
  const estimator = objectAt(definitions, 'estimator');
  const types = objectAt(objectAt(estimator, 'properties'), 'type')['enum'];
  if (!Array.isArray(types)) return schema;
  const allOf = types.map((type) => ({
    if: { properties: { type: { const: type } } },
    then: { properties: propertiesOf(estimator, textOf(type)) },
  }));
  return { ...schema, $defs: { ...definitions, estimator: { ...estimator, allOf } } };
}

function propertiesOf(estimator: JsonObject, type: string): JsonObject {
  const others = Object.entries(kOnly).filter(([, owners]) => !owners.includes(type));
  const properties: JsonObject = Object.fromEntries(others.map(([name]) => [name, false]));
  const known = kParameters[type];
  if (known !== undefined) {
    const { description } = objectAt(objectAt(estimator, 'properties'), 'parameters');
    properties['parameters'] = {
      type: 'object',
      additionalProperties: false,
      properties: known,
      default: {},
      ...(description === undefined ? {} : { description: `Parameters of ${type}.` }),
    };
  }
  return properties;
}

/** A new estimator next to others, with a name of its own. */
export function newEstimator(others: readonly Json[], type: string): JsonObject {
  return { name: nameFor(others, type), type };
}

/** Another type: parameters and fields of the old one go, a name that was its type's follows. */
export function withType(estimator: JsonObject, type: string, others: readonly Json[]): JsonObject {
  const before = textOf(estimator['type']);
  const kept = Object.entries(estimator).filter(
    ([field]) => field !== 'parameters' && (kOnly[field]?.includes(type) ?? true),
  );
  const changed: JsonObject = { ...Object.fromEntries(kept), type };
  const name = textOf(estimator['name']);
  const named =
    name === before || (name.startsWith(before) && /^_\d+$/.test(name.slice(before.length)));
  if (named || name === '') changed['name'] = nameFor(others, type);
  return changed;
}

function nameFor(others: readonly Json[], type: string): string {
  const names = new Set(others.filter(isObject).map((other) => objectOf(other)['name']));
  let name = type;
  for (let i = 2; names.has(name); i += 1) name = `${type}_${i}`;
  return name;
}
