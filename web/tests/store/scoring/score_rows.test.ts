import { describe, expect, it } from 'vitest';
import type { Evaluation } from '../../../src/protocol/score_types';
import {
  exportScores,
  offsetTexts,
  scoreAlignments,
  scoreRows,
} from '../../../src/store/scoring/score_rows';
import {
  scoreDrifts,
  pathMarks,
  scorePaths,
  scoreSpan,
  scoreSpecs,
} from '../../../src/store/scoring/score_specs';

const table = (columns: Record<string, (number | null)[]>) => ({ t_s: [1000, 1001], ...columns });
const poses = {
  positions: table({ x_m: [0, 1], y_m: [0, 0], z_m: [5, 5] }),
  attitudes: table({ roll_deg: [0, 0], pitch_deg: [0, 0], yaw_deg: [179, -179] }),
};
const evaluation: Evaluation = {
  truth: { name: 'file:d/t.tum', poses: 2, first_s: 1000, path_m: 1, warnings: [], series: poses },
  estimates: [
    {
      name: 'file:d/e.tum',
      warnings: ['1 pose was left out'],
      alignments: {
        sim3: { position_rmse_m: 0.1234567890123, horizontal_rmse_m: 0.1, scale: 2 },
        init_scale: { position_rmse_m: 3, degenerate: 'a straight line' },
      },
      series: {
        sim3: {
          ...poses,
          errors: table({ position_m: [0.5, null], rotation_deg: [1, 2] }),
          axis_errors: table({ along_m: [0, 0], across_m: [0, 0], up_m: [0, 0] }),
          scale: { t_s: [] },
          relative: { t_s: [] },
        },
      },
    },
    { name: 'file:d/bad.tum', error: { code: 'unreadable', message: 'line 3 is no pose' } },
  ],
};

describe('scoreRows', () => {
  it('has one row for each alignment, and the reason of a failure', () => {
    const rows = scoreRows(evaluation);
    expect(rows.map(({ alignment, failed }) => [alignment, failed])).toEqual([
      ['sim3', false],
      ['init_scale', false],
      ['', true],
    ]);
    expect(rows[0]?.cells.slice(0, 4).map(({ text }) => text)).toEqual([
      '2.0000',
      '0.123',
      '0.100',
      '–',
    ]);
    expect(rows[1]?.hints).toEqual(['1 pose was left out', 'a straight line']);
    expect(rows[2]?.hints).toEqual(['line 3 is no pose']);
    expect(scoreAlignments(evaluation)).toEqual(['init_scale', 'sim3']);
  });
});

describe('offsetTexts', () => {
  it('says which offsets explain the errors, if any do', () => {
    expect(offsetTexts(evaluation)).toEqual([]);
    const clock = {
      time_offset_s: -0.04,
      position_rmse_before_m: 1.07,
      position_rmse_after_m: 0.18,
      explained: 0.97,
    };
    const mount = {
      angle_deg: 7,
      rotation_rmse_before_deg: 7.1,
      rotation_rmse_after_deg: 0.5,
      explained: 0.99,
    };
    const [estimate] = evaluation.estimates;
    if (estimate === undefined) throw new Error('no estimate');
    const estimates = [{ ...estimate, offsets: { clock, mount } }];
    const texts = offsetTexts({ ...evaluation, estimates });
    expect(texts).toHaveLength(2);
    expect(texts[0]).toContain('clock is 40.0 ms late, which explains 97 %');
    expect(texts[0]).toContain('RMSE 1.070 m, without it 0.180 m');
    expect(texts[1]).toContain('rotation of 7.00 deg explains 99 %');
  });
});

describe('exportScores', () => {
  it('writes every digit as CSV', () => {
    const lines = exportScores(evaluation, 'CSV').split('\n');
    const [head = [], first = [], ...rest] = lines.slice(0, 4).map((line) => line.split(','));
    expect(rest.map(({ length }) => length)).toEqual([head.length, head.length]);
    expect(first).toHaveLength(head.length);
    const given = head.flatMap((name, i) => (first[i] === '' ? [] : [[name, first[i]]]));
    expect(given).toEqual([
      ['truth', 'file:d/t.tum'],
      ['estimate', 'file:d/e.tum'],
      ['alignment', 'sim3'],
      ['scale', '2'],
      ['position_rmse_m', '0.1234567890123'],
      ['horizontal_rmse_m', '0.1'],
    ]);
  });

  it('writes what is shown as Markdown and LaTeX', () => {
    expect(exportScores(evaluation, 'Markdown')).toContain(
      '| d/e.tum | sim3 | 2.0000 | 0.123 | 0.100 | – |',
    );
    expect(exportScores(evaluation, 'LaTeX')).toContain('d/e.tum & init\\_scale & -- & 3.000');
  });
});

describe('scoreSpecs', () => {
  it('counts the time from the first pose of the truth', () => {
    const [x, , , , , yaw] = scoreSpecs(evaluation, 'sim3', 'pose');
    expect(scoreSpan(evaluation)).toEqual([0, 1]);
    expect(x?.curves.map(({ name }) => name)).toEqual(['truth', 'd/e.tum']);
    expect(x?.curves[1]?.curve()).toMatchObject({ t_offset_s: -1000, wraps: false });
    expect(yaw?.curves[0]?.curve()).toMatchObject({ wraps: true });
  });

  it('plots errors, with gaps where there are none', () => {
    const specs = scoreSpecs(evaluation, 'sim3', 'errors');
    expect(specs.map(({ key }) => key)).toEqual([
      'position_m',
      'along_m',
      'across_m',
      'up_m',
      'rotation_deg',
    ]);
    const values = specs[0]?.curves[0]?.curve()?.values;
    expect([...(values as Float64Array)]).toEqual([0.5, NaN]);
    expect(scoreSpecs(evaluation, 'init_scale', 'errors')[0]?.curves).toEqual([]);
  });

  it('plots the drift over the length of the sub-path', () => {
    const [first] = evaluation.estimates;
    const relative = [
      { length_m: 100, pairs: 9, translation_percent: 1.25, rotation_deg_per_100m: 0.5 },
      { length_m: 200, pairs: 4, translation_percent: 1, rotation_deg_per_100m: 0.1 },
    ];
    const estimates = [{ name: 'e', ...first, alignments: { sim3: { relative } } }];
    const specs = scoreDrifts({ ...evaluation, estimates }, 'sim3');
    expect(specs.map(({ unit }) => unit)).toEqual(['%', 'deg / 100 m']);
    expect(specs[1]?.curves[0]).toMatchObject({
      name: 'd/e.tum',
      lengths_m: [100, 200],
      values: [0.5, 0.1],
      pairs: [9, 4],
    });
    expect(scoreDrifts(evaluation, 'sim3')).toEqual([]);
    expect(scoreSpecs(evaluation, 'sim3', 'drift')).toEqual([]);
  });
});

describe('scorePaths', () => {
  it('has the tracks of the truth and the estimates, with a mark at a time', () => {
    const paths = scorePaths(evaluation, 'sim3', 'x_m', 'z_m');
    expect(paths.map(({ hue }) => hue.kind)).toEqual(['truth', 'estimate']);
    expect([...(paths[0]?.y as Float64Array)]).toEqual([5, 5]);
    expect(pathMarks(paths, 0.5).map(({ x, y }) => [x, y])).toEqual([
      [0, 5],
      [0, 5],
    ]);
    expect(pathMarks(paths, 1).map(({ x }) => x)).toEqual([1, 1]);
    expect(pathMarks(paths, -1)).toEqual([]);
  });
});
