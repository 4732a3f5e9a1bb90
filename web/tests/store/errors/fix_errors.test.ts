import { describe, expect, it } from 'vitest';
import type { AlignmentErrors, Nees } from '../../../src/protocol/rest_types';
import { errorTable, joinedTables } from '../../../src/store/errors/error_table';
import { fixColumns, kFixCsvHead, fixCsvValues } from '../../../src/store/errors/fix_errors';

const nees = (mean: number, honesty: string): Nees => ({
  degrees: 3,
  samples: 250,
  mean,
  band_95: [2.7, 3.31],
  deviation_ratio: Math.sqrt(mean / 3),
  honesty,
});

const long: AlignmentErrors = {
  fix_drift: [
    { interval_m: 1000, segments: 12, apart: 2, median_m: 3.456, worst_m: 9.5 },
    { interval_m: 2000, segments: 3, apart: 1, median_m: 7, worst_m: 8 },
    { interval_m: 5000, unavailable: 'the path is shorter' },
  ],
  consistency: {
    position: nees(12, 'overconfident'),
    rotation: nees(3, 'consistent'),
    pose: null,
    honesty: 'overconfident',
  },
};

const table = (errors: AlignmentErrors, name = 'feature') =>
  errorTable(
    { estimators: { [name]: { outcome: 'COMPLETED', alignments: { sim3: errors } } } },
    'sim3',
  );

describe('fix errors', () => {
  it('shows the drift between fixes where the path has them, and the honesty of covariances', () => {
    const rows = table(long).rows.filter(({ key }) => /^(fix|nees)/.test(key));
    expect(rows.map(({ key, cells, bad }) => [key, cells, bad])).toEqual([
      ['fix_drift_1000m', ['3.46 (9.50)'], [false]],
      ['fix_drift_2000m', ['7.00 (8.00)'], [false]],
      ['nees_position', ['12.00 [2.70, 3.31] overconfident'], [true]],
      ['nees_rotation', ['3.00 [2.70, 3.31]'], [false]],
    ]);
    expect(rows[0]?.cellHints).toEqual(['12 segments, 2 of them without overlap']);
    expect(rows[2]?.cellHints[0]).toContain('Errors are 2.00 times the stated');
  });

  it('leaves them out of runs without them', () => {
    expect(table({}).rows.filter(({ key }) => /^(fix|nees)/.test(key))).toEqual([]);
  });

  it('joins runs of which only one has them, in any order', () => {
    for (const tables of [
      [table({}, 'a'), table(long, 'b')],
      [table(long, 'b'), table({}, 'a')],
    ]) {
      const joined = joinedTables(tables);
      const place = tables[0]?.estimators[0]?.name === 'b' ? 0 : 1;
      const row = (key: string) => joined.rows.find((one) => one.key === key);
      expect(row('nees_position')?.cells[place]).toContain('overconfident');
      expect(row('nees_position')?.cells[1 - place]).toBe('–');
      expect(row('nees_position')?.bad?.[place]).toBe(true);
      expect(row('coverage')?.cells).toHaveLength(2);
      expect(joined.rows.map(({ key }) => key).indexOf('fix_drift_1000m')).toBeGreaterThan(
        joined.rows.map(({ key }) => key).indexOf('relative_800m'),
      );
      expect(joined.rows.at(-1)?.key).toBe('dropped_frames');
    }
  });

  it('has them as columns, and with every digit as CSV', () => {
    expect(fixColumns([{}, long]).map(({ label }) => label)).toEqual([
      'Drift between fixes, 1 km',
      'Drift between fixes, 2 km',
      'NEES position',
      'NEES rotation',
    ]);
    expect(fixColumns([{}])).toEqual([]);
    const values = fixCsvValues(long);
    expect(values).toHaveLength(kFixCsvHead.length);
    expect(values[kFixCsvHead.indexOf('fix_drift_median_1000m')]).toBe(3.456);
    expect(values[kFixCsvHead.indexOf('nees_position_high_95')]).toBe(3.31);
    expect(values.at(-1)).toBe('overconfident');
  });
});
