import { describe, expect, it } from 'vitest';
import schemaText from '../../../../scenarios/scenario.schema.json?raw';
import scenarioDocs from '../../../../docs/SCENARIOS.md?raw';
import type { JsonObject } from '../../../src/protocol/rest_types';
import {
  kParameters,
  newEstimator,
  withEstimatorTypes,
  withType,
} from '../../../src/store/scenario/estimator_schema';
import { labelOf, unitOf } from '../../../src/store/scenario/field_names';

describe('types of estimators', () => {
  it('are those of the schema, each with a condition', () => {
    const plain = JSON.parse(schemaText) as { $defs: { estimator: JsonObject } };
    const schema = withEstimatorTypes(plain as unknown as JsonObject) as typeof plain;
    expect(schema.$defs.estimator['allOf']).toHaveLength(9);
    expect(plain.$defs.estimator).not.toHaveProperty('allOf');
  });

  it('have the parameters that the documentation has', () => {
    const [, table = ''] =
      /### Parameters of `feature`\n([\s\S]+?)\n\n\*\*/u.exec(scenarioDocs) ?? [];
    const names = [...table.matchAll(/^\| ((?:`\w+`(?:, )?)+) \|/gmu)].flatMap(([, cell = '']) =>
      [...cell.matchAll(/`(\w+)`/gu)].map(([, name]) => name),
    );
    expect(new Set(Object.keys(kParameters['feature'] ?? {}))).toEqual(new Set(names));
  });

  it('give a new estimator a name of its own', () => {
    const first = newEstimator([], 'feature');
    expect(first).toEqual({ name: 'feature', type: 'feature' });
    expect(newEstimator([first], 'feature')['name']).toBe('feature_2');
  });

  it('keep only what the new type has, and rename what was named after the old one', () => {
    const door = {
      name: 'process_2',
      type: 'process',
      command: ['a'],
      parameters: { gain: 1 },
      camera: 'down',
    };
    expect(withType(door, 'feature', [])).toEqual({
      name: 'feature',
      type: 'feature',
      camera: 'down',
    });
    expect(withType({ ...door, name: 'mine' }, 'lcm', [])['name']).toBe('mine');
  });
});

describe('names of fields', () => {
  it('are read without their unit', () => {
    const read = (name: string) => [labelOf(name), unitOf(name)];
    expect(read('width_px')).toEqual(['Width', 'px']);
    expect(read('height_agl_m')).toEqual(['Height AGL', 'm']);
    expect(read('airspeed_m_s')).toEqual(['Airspeed', 'm/s']);
    expect(read('electrons_per_s')).toEqual(['Electrons', '1/s']);
    expect(read('fov_deg')).toEqual(['Field of view', 'deg']);
    expect(read('seed')).toEqual(['Seed', '']);
  });
});
