import { describe, expect, it } from 'vitest';
import schemaText from '../../../../scenarios/scenario.schema.json?raw';
import courseText from '../../../../scenarios/course.json?raw';
import type { JsonObject } from '../../../src/protocol/rest_types';
import { withValue } from '../../../src/store/scenario/draft';
import { withEstimatorTypes } from '../../../src/store/scenario/estimator_schema';
import type { FormNode } from '../../../src/store/scenario/form_nodes';
import {
  errorsByPath,
  formOf,
  valueOfInput,
  valueOfJson,
} from '../../../src/store/scenario/form_nodes';
import { sectionOfField, sectionsOf } from '../../../src/store/scenario/sections';

const schema = withEstimatorTypes(JSON.parse(schemaText) as JsonObject);
const course = JSON.parse(courseText) as JsonObject;

function flat(nodes: readonly FormNode[]): Map<string, FormNode> {
  const all = new Map<string, FormNode>();
  const visit = (node: FormNode) => {
    all.set(node.path, node);
    if (node.kind === 'group' || node.kind === 'variant') node.children.forEach(visit);
    if (node.kind === 'list') node.entries.forEach(({ children }) => children.forEach(visit));
  };
  nodes.forEach(visit);
  return all;
}

const form = (section: string, document = course) => flat(formOf(schema, section, document));

describe('the sections of the editor', () => {
  it('are the single values together, and each of the others', () => {
    expect(sectionsOf(schema).slice(0, 6)).toEqual([
      'general',
      'flight',
      'camera',
      'cameras',
      'estimators',
      'world',
    ]);
    expect([...form('general').keys()]).toEqual([
      'title',
      'description',
      'seed',
      'start_s',
      'duration_s',
      'pacing',
      'epoch_utc_s',
    ]);
    expect(sectionOfField(schema, 'camera.width_px')).toBe('camera');
    expect(sectionOfField(schema, 'duration_s')).toBe('general');
  });
});

describe('the form of a section', () => {
  it('has labels, units, limits and usual values of the schema', () => {
    expect(form('camera').get('camera.width_px')).toMatchObject({
      kind: 'value',
      input: 'number',
      label: 'Width',
      unit: 'px',
      text: '1280',
      usual: '1280',
      hint: 'in [16, 8192]',
    });
    expect(form('camera').get('camera.rate_hz')).toMatchObject({ label: 'Rate', unit: 'Hz' });
    expect(form('camera').get('camera.fov_axis')).toMatchObject({
      input: 'choice',
      choices: ['horizontal', 'vertical', 'diagonal'],
    });
    expect(form('flight').get('flight.course.roll_rate_max_deg_s')).toMatchObject({
      unit: 'deg/s',
      hint: 'in (0, 200]',
    });
  });

  it('offers a lens that the camera does not have, to be filled in', () => {
    const lens = form('camera').get('camera.distortion');
    expect(lens).toMatchObject({ kind: 'group', label: 'Lens', absent: true });
    if (lens?.kind !== 'group') return;
    const fitted = form('camera', withValue(course, 'camera.distortion', lens.fresh));
    expect(fitted.get('camera.distortion.model')).toMatchObject({ text: 'radtan' });
    expect(fitted.get('camera.distortion.coefficients')).toMatchObject({
      input: 'numbers',
      text: '',
      required: true,
    });
  });

  it('shows the world and the flight that are chosen among several', () => {
    const world = form('world').get('world');
    expect(world).toMatchObject({ kind: 'variant', chosen: 0, required: true });
    expect(form('world').has('world.builtin.seed')).toBe(true);
    if (world?.kind !== 'variant') return;
    expect(world.choices.map(({ label }) => label)).toEqual(['builtin', 'manifest', 'imagery']);
    const other = form('world', { ...course, world: { manifest: 'here.json' } });
    expect(other.get('world.manifest')).toMatchObject({ kind: 'value', text: 'here.json' });
    expect(form('flight').get('flight.course.start')).toMatchObject({
      choices: [{ label: 'runway', fresh: 'runway' }, { label: '{east_m, north_m}' }],
    });
  });

  it('has the parameters of the estimator type, with limits', () => {
    expect(form('estimators').get('estimators.0.parameters')).toMatchObject({
      absent: false,
      required: true,
    });
    const given = withValue(course, 'estimators.0.parameters', { features: 700 });
    const filled = form('estimators', given);
    expect(filled.get('estimators.0.parameters.features')).toMatchObject({
      text: '700',
      usual: '2000',
      hint: 'in [100, 20000] · Corners per image.',
    });
    expect(filled.get('estimators.0.parameters.low_texture')).toMatchObject({ input: 'switch' });
    expect(filled.has('estimators.0.command')).toBe(false);
    const door = form('estimators', withValue(course, 'estimators.0.type', 'process'));
    expect(door.get('estimators.0.command')).toMatchObject({ kind: 'json' });
    expect(door.get('estimators.0.parameters')).toMatchObject({ kind: 'json' });
    const hold = form('estimators', withValue(course, 'estimators.0.type', 'baseline_hold'));
    expect(hold.get('estimators.0.parameters')).toMatchObject({
      absent: false,
      hint: 'Parameters of baseline_hold. This type has no parameters.',
    });
  });

  it('keeps text that is no value, for its error', () => {
    expect(valueOfInput('number', ' 1e2 ')).toBe(100);
    expect(valueOfInput('number', '12x')).toBe('12x');
    expect(valueOfInput('number', '')).toBeUndefined();
    expect(valueOfInput('numbers', '1, 2 -3')).toEqual([1, 2, -3]);
    expect(valueOfInput('numbers', '1, b')).toEqual([1, 'b']);
    expect(valueOfInput('switch', 'false')).toBe(false);
    expect(valueOfInput('text', 'two words ')).toBe('two words ');
    expect(valueOfJson('{"a": 1}')).toEqual({ a: 1 });
    expect(valueOfJson('{"a"')).toBe('{"a"');
    expect(valueOfJson(' ')).toBeUndefined();
  });

  it('shows an error at its field, or at the one that contains it', () => {
    const errors = [
      { field: 'camera.width_px', message: 'must be in [16, 8192]' },
      { field: 'camera.mount.p_body_m.2', message: 'must be a number' },
      { field: 'camera', message: 'is wrong' },
      { field: 'seed', message: 'is elsewhere' },
    ];
    const found = errorsByPath(['camera', 'camera.width_px', 'camera.mount.p_body_m'], errors);
    expect([...found]).toEqual([
      ['camera.width_px', 'must be in [16, 8192]'],
      ['camera.mount.p_body_m', '2: must be a number'],
      ['camera', 'is wrong'],
    ]);
  });
});
