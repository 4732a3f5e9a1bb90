import { describe, expect, it } from 'vitest';
import schemaText from '../../../../scenarios/scenario.schema.json?raw';
import courseText from '../../../../scenarios/course.json?raw';
import faultsText from '../../../../scenarios/camera_faults.json?raw';
import realText from '../../../../scenarios/real_camera.json?raw';
import missionText from '../../../../scenarios/airfield_mission.json?raw';
import type { Json, JsonObject } from '../../../src/protocol/rest_types';
import { withEstimatorTypes } from '../../../src/store/scenario/estimator_schema';
import { documentErrors } from '../../../src/store/scenario/schema_check';

const schema = withEstimatorTypes(JSON.parse(schemaText) as JsonObject);
const course = JSON.parse(courseText) as JsonObject;

const small: JsonObject = {
  properties: {
    lens: { $ref: '#/$defs/lens', description: 'What is before the sensor.' },
    events: {
      type: 'array',
      maxItems: 2,
      items: {
        type: 'object',
        additionalProperties: false,
        required: ['kind'],
        properties: {
          kind: { enum: ['dirt', 'blackout'] },
          at_s: { type: 'number', minimum: 0, exclusiveMaximum: 10 },
        },
      },
    },
    gains: { type: 'object', maxProperties: 1, additionalProperties: { type: 'number' } },
    name: { type: 'string', minLength: 1, maxLength: 4, pattern: '^[a-z]+$' },
    version: { const: 1 },
  },
  $defs: { lens: { type: 'object', properties: { k: { type: 'integer' } } } },
};

const texts = (section: string, value: Json, root = small) =>
  documentErrors(root, { [section]: value }).map(({ field, message }) => `${field}: ${message}`);
const changed = (change: JsonObject) =>
  documentErrors(schema, { ...course, ...change }).map(
    ({ field, message }) => `${field}: ${message}`,
  );

describe('the check of a scenario in the browser', () => {
  it('names the path, the limit and the names that exist', () => {
    expect(texts('events', [{ kind: 'dirt', at_s: 3 }])).toEqual([]);
    expect(texts('events', [{ kind: 'mud' }])).toEqual([
      'events.0.kind: must be one of "dirt", "blackout"',
    ]);
    expect(texts('events', [{ at_s: 10, when: 1 }])).toEqual([
      'events.0.kind: is required',
      'events.0.at_s: must be in [0, 10)',
      'events.0.when: is not a known field',
    ]);
    expect(texts('events', [{}, {}, {}])[0]).toBe('events: must have at most 2 entries');
    expect(texts('events', {})).toEqual(['events: must be a list']);
    expect(texts('lens', { k: 1.5 })).toEqual(['lens.k: must be an integer']);
  });

  it('knows constants, lengths, patterns and objects of any names', () => {
    expect(texts('version', 2)).toEqual(['version: must be 1']);
    expect(texts('name', '')).toEqual(['name: must not be empty']);
    expect(texts('name', 'abcde')).toEqual(['name: must have at most 4 characters']);
    expect(texts('name', 'A')).toEqual(['name: must match ^[a-z]+$']);
    expect(texts('gains', { p: 1, i: 'x' })).toEqual([
      'gains: must have at most 1 fields',
      'gains.i: must be a number',
    ]);
  });

  it('accepts the scenarios of the server', () => {
    for (const text of [courseText, faultsText, realText, missionText]) {
      expect(documentErrors(schema, JSON.parse(text) as JsonObject)).toEqual([]);
    }
  });

  it('accepts what the schema itself offers as default', () => {
    const properties = schema['properties'] as Record<string, JsonObject>;
    for (const [section, { default: value }] of Object.entries(properties)) {
      if (value === undefined) continue;
      expect(documentErrors(schema, { ...course, [section]: value })).toEqual([]);
    }
  });

  it('shows the errors of the alternative that is meant', () => {
    expect(changed({ world: { builtin: { seed: -1 } } })).toEqual([
      'world.builtin.seed: must be in [0, 9007199254740991]',
    ]);
    expect(changed({ world: {} })).toEqual([
      'world: must be exactly one of builtin, manifest, imagery',
    ]);
    expect(changed({ world: { builtin: {}, manifest: 'a' } })).toEqual([
      'world: must be exactly one of builtin, manifest, imagery',
    ]);
    expect(changed({ flight: { mission: {} } })).toEqual([
      'flight.mission: must be exactly one of a mission with a file, a mission with a plan',
    ]);
    expect(changed({ flight: { course: { start: { east_m: 1 } } } })).toEqual([
      'flight.course.start: must be exactly one of "runway", {east_m, north_m}',
    ]);
  });

  it('asks for what a given field needs', () => {
    expect(changed({ light: { sun_azimuth_deg: 10 } })).toEqual([
      'light.sun_elevation_deg: is required with sun_azimuth_deg',
    ]);
    expect(changed({ camera: { fx_px: 900 } })).toEqual(['camera.fy_px: is required with fx_px']);
  });

  it('asks for sections that every scenario needs', () => {
    const { world: _world, ...rest } = course;
    void _world;
    expect(documentErrors(schema, rest)).toEqual([{ field: 'world', message: 'is required' }]);
  });

  it('knows the parameters of the native estimators, and which fields a type has', () => {
    const errors = (estimator: JsonObject) =>
      changed({ estimators: [{ name: 'a', ...estimator }] });
    expect(errors({ type: 'feature', parameters: { features: 800, low_texture: false } })).toEqual(
      [],
    );
    expect(errors({ type: 'feature', parameters: { features: 5, gain: 1 } })).toEqual([
      'estimators.0.parameters.features: must be in [100, 20000]',
      'estimators.0.parameters.gain: is not a known field',
    ]);
    expect(errors({ type: 'baseline_hold', parameters: { features: 500 } })).toHaveLength(1);
    expect(errors({ type: 'process', command: ['a'], parameters: { gain: 1 } })).toEqual([]);
    expect(errors({ type: 'feature', command: ['a'] })).toEqual([
      'estimators.0.command: does not belong to this type',
    ]);
  });
});
