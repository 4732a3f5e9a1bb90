import { describe, expect, it } from 'vitest';
import {
  driftAt,
  driftCsv,
  driftExtent,
  driftSpecs,
  nearestLength,
} from '../../../src/store/plots/drift_specs';
import { Viewing } from '../../support/viewing';

function scored(): Viewing {
  const viewing = new Viewing();
  viewing.watch();
  const of = (length_m: number, translation_percent: number) => ({
    length_m,
    translation_percent,
    rotation_deg_per_100m: translation_percent / 10,
    pairs: 1000 - length_m,
  });
  const alignments = { init_scale: { relative: [of(200, 1.5), of(100, 2)] }, sim3: {} };
  const metrics = { estimators: { feature: { outcome: 'COMPLETED', alignments } } };
  viewing.socket.receive({ type: 'metrics', run: 'r1', metrics });
  return viewing;
}

describe('driftSpecs', () => {
  it('has the figures of the score by length', () => {
    const [translation, rotation] = driftSpecs(scored().store.state);
    expect(translation).toMatchObject({ key: 'translation_percent', unit: '%' });
    expect(translation?.curves[0]).toMatchObject({
      name: 'feature',
      lengths_m: [100, 200],
      values: [2, 1.5],
      pairs: [900, 800],
    });
    expect(rotation?.unit).toBe('deg / 100 m');
    expect(rotation?.curves[0]?.values).toEqual([0.2, 0.15]);
  });

  it('shows no hidden estimates, and nothing before the score', () => {
    const viewing = scored();
    viewing.session.showTrack('r1', 'feature', false);
    expect(driftSpecs(viewing.store.state)).toEqual([]);
    const flying = new Viewing();
    flying.watch();
    expect(driftSpecs(flying.store.state)).toEqual([]);
  });
});

describe('driftExtent', () => {
  const hue = { kind: 'estimate', colour: 0 } as const;
  const of = (...values: number[]) => ({ name: 'a', hue, lengths_m: [100], values, pairs: [1] });
  const spec = { key: '', label: '', unit: '', hint: '', digits: 3, least: 0.1 };

  it('leaves out an estimate that has diverged', () => {
    const curves = [of(4e11, 1e11), of(), of(0.1), of(2, 1)];
    expect(driftExtent({ ...spec, curves })).toMatchObject({ high: [2], beyond: [0] });
    expect(driftExtent({ ...spec, curves: [] })).toBeNull();
  });
});

describe('values by length', () => {
  const hue = { kind: 'run', order: 0 } as const;
  const curve = { name: 'a', hue, lengths_m: [100, 400], values: [1, 2], pairs: [9, 3] };

  it('are read at the lengths of the score only', () => {
    expect(driftAt(curve, 400)).toBe(2);
    expect(driftAt(curve, 200)).toBeNull();
    expect(nearestLength([curve, { ...curve, lengths_m: [200] }], 240)).toBe(200);
    expect(nearestLength([], 240)).toBeNull();
  });

  it('are saved', () => {
    const [, first] = driftCsv(driftSpecs(scored().store.state)).split('\n');
    expect(first).toBe('translation_percent,feature,100,2,900');
  });
});
