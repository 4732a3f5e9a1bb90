import { describe, expect, it } from 'vitest';
import type { JsonObject } from '../../../src/protocol/rest_types';
import {
  draftOf,
  editsWith,
  editsWithText,
  overridesBetween,
  sameJson,
  valueIn,
  withValue,
} from '../../../src/store/scenario/draft';

const base: JsonObject = {
  seed: 1,
  duration_s: 20,
  camera: { width_px: 1280, mount: { roll_deg: 0 } },
  estimators: [
    { name: 'a', parameters: {} },
    { name: 'b', parameters: { features: 900 } },
  ],
};

describe('the changed scenario', () => {
  it('has the edited sections, and reports text that is not JSON', () => {
    const { document, errors } = draftOf(
      base,
      new Map([
        ['seed', '2'],
        ['duration_s', ' '],
        ['camera', '{'],
      ]),
    );
    expect(document).toEqual({ seed: 2, camera: base['camera'], estimators: base['estimators'] });
    expect(errors.map(({ field }) => field)).toEqual(['camera']);
    expect(errors[0]?.message).toMatch(/^is not JSON/u);
  });

  it('changes values in objects and lists without touching the original', () => {
    const copy = structuredClone(base);
    const changed = withValue(base, 'estimators.1.parameters.features', 500);
    expect(valueIn(changed, 'estimators.1.parameters.features')).toBe(500);
    expect(withValue(base, 'estimators.0', undefined)['estimators']).toEqual([
      { name: 'b', parameters: { features: 900 } },
    ]);
    expect(withValue(base, 'light.clouds.cover', 0.5)['light']).toEqual({ clouds: { cover: 0.5 } });
    expect(withValue(base, 'duration_s', undefined)).not.toHaveProperty('duration_s');
    expect(base).toEqual(copy);
  });

  it('counts as edited only what differs', () => {
    const none = new Map<string, string>();
    const changed = withValue(base, 'camera.width_px', 640);
    const edits = editsWith(base, none, changed, 'camera.width_px');
    expect([...edits.keys()]).toEqual(['camera']);
    expect(draftOf(base, edits).document).toEqual(changed);
    expect(editsWith(base, edits, base, 'camera.width_px').size).toBe(0);
    expect(editsWithText(base, none, 'seed', '1').size).toBe(0);
  });

  it('is told to the server by the values that differ', () => {
    const changed = withValue(withValue(base, 'camera.width_px', 640), 'seed', 3);
    expect(overridesBetween(base, changed)).toEqual({ 'camera.width_px': 640, seed: 3 });
    expect(overridesBetween(base, base)).toEqual({});
  });

  it('is told as whole objects and lists where paths do not suffice', () => {
    const removed = withValue(base, 'camera.mount.roll_deg', undefined);
    expect(overridesBetween(base, removed)).toEqual({ 'camera.mount': {} });
    const listed = withValue(base, 'estimators.1.name', 'c');
    expect(overridesBetween(base, listed)).toEqual({ estimators: listed['estimators'] });
    const dotted = withValue(base, 'camera.mount', { roll_deg: 0, 'a.b': 1 });
    expect(overridesBetween(base, dotted)).toEqual({ 'camera.mount': { roll_deg: 0, 'a.b': 1 } });
    expect(overridesBetween(base, withValue(base, 'duration_s', undefined))).toBeNull();
  });

  it('is the same whatever the order of its fields', () => {
    expect(sameJson({ a: 1, b: [1, { c: null }] }, { b: [1, { c: null }], a: 1 })).toBe(true);
    expect(sameJson({ a: 1 }, { a: 1, b: 2 })).toBe(false);
    expect(sameJson([1, 2], [2, 1])).toBe(false);
  });
});
