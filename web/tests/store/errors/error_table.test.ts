import { describe, expect, it } from 'vitest';
import type { Metrics } from '../../../src/protocol/rest_types';
import {
  alignmentModes,
  errorTable,
  outcomeText,
  reportedVoidShare,
  texelsPerPixel,
  textureHint,
  textureLimited,
} from '../../../src/store/errors/error_table';
import { shownLengths_m } from '../../../src/store/errors/error_figures';
import { sampleRun } from '../../support/samples';

const metrics: Metrics = {
  flight: { duration_s: 10, path_length_m: 345.6 },
  estimators: {
    feature: {
      outcome: 'LOST',
      outcome_time_s: 12.34,
      outcome_distance_m: 308.6,
      coverage: 0.5,
      dropped_frames: 3,
      alignments: {
        sim3: { scale: 2, position_rmse_m: 1 },
        init_scale: {
          scale: 41.20314,
          position_rmse_m: 3.456,
          horizontal_rmse_m: 3.4,
          vertical_rmse_m: 0.62,
          position_rmse_hold_m: 500,
          rotation_rmse_deg: 0.5,
          rotation_euler_norm_rmse_deg: null,
          position_auc: 0.3456,
          relative: [
            { length_m: 100, pairs: 9, translation_percent: 1.25, rotation_deg_per_100m: 0.5 },
            { length_m: 300, pairs: 4, translation_percent: 1, rotation_deg_per_100m: 0.1 },
          ],
        },
      },
    },
    none: { outcome: 'NOT_INITIALISED', outcome_time_s: null, coverage: 0, alignments: {} },
  },
  camera: { frames: 10, texels_per_pixel: { min: 0.2, median: 0.49 } },
};

describe('errorTable', () => {
  it('keeps the order in which the flight names its estimators', () => {
    const table = errorTable(metrics, 'init_scale', ['none', 'feature']);
    expect(table.estimators.map(({ name }) => name)).toEqual(['none', 'feature']);
    const coverage = table.rows.find(({ key }) => key === 'coverage');
    expect(coverage?.cells).toEqual(['0.0 %', '50.0 %']);
  });

  it('shows the figures of the chosen alignment next to outcome and coverage', () => {
    const table = errorTable(metrics, 'init_scale');
    expect(table.estimators).toEqual([
      { name: 'feature', outcome: 'LOST at 12.3 s, 309 m', good: false },
      { name: 'none', outcome: 'NOT_INITIALISED', good: false },
    ]);
    const cells = Object.fromEntries(table.rows.map(({ key, cells: row }) => [key, row]));
    expect(cells).toEqual({
      coverage: ['50.0 %', '0.0 %'],
      scale: ['41.2031', '–'],
      position_rmse_m: ['3.456', '–'],
      horizontal_rmse_m: ['3.400', '–'],
      vertical_rmse_m: ['0.620', '–'],
      percent_of_path: ['1.000', '–'],
      position_rmse_hold_m: ['500.000', '–'],
      rotation_rmse_deg: ['0.500', '–'],
      rotation_euler_norm_rmse_deg: ['–', '–'],
      position_auc: ['0.346', '–'],
      relative_100m: ['1.250', '–'],
      relative_200m: ['–', '–'],
      relative_400m: ['–', '–'],
      relative_800m: ['–', '–'],
      dropped_frames: ['3', '–'],
    });
  });

  it('has no share of a path that is not known', () => {
    const { rows } = errorTable({ ...metrics, flight: {} }, 'init_scale');
    expect(rows.find(({ key }) => key === 'percent_of_path')?.cells).toEqual(['–', '–']);
  });

  it('has no area under the curve where no alignment has one', () => {
    const { rows } = errorTable(metrics, 'sim3');
    expect(rows.map(({ key }) => key)).not.toContain('position_auc');
  });

  it('shows kilometres between position fixes where the path has them', () => {
    const relative = [
      { length_m: 2000, pairs: 3, translation_percent: 0.5, rotation_deg_per_100m: 0 },
    ];
    expect(shownLengths_m([{ relative }, {}])).toEqual([100, 200, 400, 800, 2000]);
    expect(shownLengths_m([])).toEqual([100, 200, 400, 800]);
  });

  it('says how many sub-paths a drift is the mean of, or that there are none', () => {
    const { rows } = errorTable(metrics, 'init_scale');
    expect(rows.find(({ key }) => key === 'relative_100m')?.cellHints).toEqual([
      '9 sub-paths; rotation 0.5000 deg per 100 m',
      'The tracked path has no part of 100 m',
    ]);
  });

  it('says why a degenerate alignment has no rotation error', () => {
    const degenerate = 'the path is nearly straight';
    const straight = { scale: 2, position_rmse_m: 1, rotation_rmse_deg: null, degenerate };
    const { rows } = errorTable(
      { estimators: { feature: { outcome: 'COMPLETED', alignments: { sim3: straight } } } },
      'sim3',
    );
    const row = (key: string) => rows.find((candidate) => candidate.key === key);
    expect(row('rotation_rmse_deg')?.cells).toEqual(['–']);
    expect(row('rotation_rmse_deg')?.cellHints).toEqual([degenerate]);
    expect(row('position_rmse_m')?.cellHints).toEqual(['']);
  });

  it("offers the alignments in the metrics, the paper's first", () => {
    expect(alignmentModes(metrics)).toEqual(['init_scale', 'sim3']);
    expect(alignmentModes(null)).toEqual([]);
  });
});

describe('outcomeText', () => {
  const lost = { outcome: 'LOST', outcome_time_s: 12.3, outcome_distance_m: 500 };

  it('says when an estimator found its map again', () => {
    expect(outcomeText({ ...lost, relocalisations: 1, relocalised_at_s: 15.1 })).toBe(
      'LOST at 12.3 s, 500 m; found its map again at 15.1 s',
    );
    expect(outcomeText({ outcome: 'COMPLETED', relocalisations: 2, relocalised_at_s: 4 })).toBe(
      'COMPLETED; found its map again 2 times, first at 4.0 s',
    );
  });

  it('says nothing of one that did not, and of older runs', () => {
    expect(outcomeText({ ...lost, relocalisations: 0, relocalised_at_s: null })).toBe(
      'LOST at 12.3 s, 500 m',
    );
    expect(outcomeText(lost)).toBe('LOST at 12.3 s, 500 m');
  });
});

describe('reportedVoidShare', () => {
  it('is that of flights which leave the imagery for more than a tenth', () => {
    const flown = (mostlyVoid: number): Metrics => ({
      camera: { frames: 200, mostly_void_frames: mostlyVoid },
    });
    expect(reportedVoidShare(flown(50))).toBe(0.25);
    expect(reportedVoidShare(flown(20))).toBeNull();
    expect(reportedVoidShare({ camera: { frames: 200 } })).toBeNull();
    expect(reportedVoidShare({ camera: { frames: 0, mostly_void_frames: 0 } })).toBeNull();
    expect(reportedVoidShare(null)).toBeNull();
  });
});

describe('textureLimited', () => {
  it('speaks up below half a texel a pixel only', () => {
    expect(textureLimited(null, metrics)).toBe(true);
    expect(textureLimited(null, { camera: { texels_per_pixel: { median: 0.5 } } })).toBe(false);
    expect(textureLimited(null, {})).toBe(false);
    expect(textureLimited(null, null)).toBe(false);
  });

  it("uses the server's own value", () => {
    const texture = { texels_per_pixel_median: 0.49, texture_limited: false };
    expect(textureLimited(null, { ...metrics, texture })).toBe(false);
    expect(textureLimited(sampleRun({ texture_limited: true }), null)).toBe(true);
  });

  it('says the figure, what it means and what to do', () => {
    expect(textureHint(texelsPerPixel(metrics))).toMatch(/0\.49 texels per pixel.*Fly higher/u);
    expect(textureHint(null)).toMatch(/imagery, not the camera, limits/u);
  });
});
