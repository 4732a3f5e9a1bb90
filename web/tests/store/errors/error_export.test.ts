import { describe, expect, it } from 'vitest';
import { exportErrors } from '../../../src/store/errors/error_export';
import { WatchedRun } from '../../../src/store/watched_run';
import { sampleRun } from '../../support/samples';

function scored(id: string, title: string): WatchedRun {
  const watched = new WatchedRun(id);
  watched.run = sampleRun({ id, title });
  watched.metrics = {
    flight: { path_length_m: 200 },
    estimators: {
      feature: {
        outcome: 'LOST',
        outcome_time_s: 3.14159,
        outcome_distance_m: 78.5,
        relocalisations: 0,
        relocalised_at_s: null,
        coverage: 0.5,
        alignments: {
          sim3: { scale: 1, position_rmse_m: 0.1234567890123 },
          init_scale: {
            scale: -2,
            position_rmse_m: 1.5,
            horizontal_rmse_m: 1.479,
            vertical_rmse_m: 0.25,
            position_auc: 0.43210987654321,
            relative: [
              { length_m: 200, pairs: 2, translation_percent: 3.5, rotation_deg_per_100m: 1 },
            ],
          },
        },
      },
    },
  };
  return watched;
}

describe('exportErrors', () => {
  it('writes every digit as CSV, one line for each alignment', () => {
    const lines = exportErrors([scored('r1', 'a, "b"')], 'CSV')
      .trimEnd()
      .split('\n');
    expect(lines).toHaveLength(3);
    expect(lines[0]).toContain(
      'run,title,estimator,outcome,outcome_time_s,outcome_distance_m,relocalisations,relocalised_at_s,coverage,alignment,scale',
    );
    expect(lines[1]).toMatch(
      /^r1,"a, ""b""",feature,LOST,3\.14159,78\.5,0,,0\.5,init_scale,-2,1\.5,/,
    );
    const cells = (line = '') => line.replace('"a, ""b"""', 'a').split(',');
    const [head, first] = [cells(lines[0]), cells(lines[1])];
    const cell = (name: string) => first[head.indexOf(name)];
    expect(first).toHaveLength(head.length);
    expect(cell('vertical_rmse_m')).toBe('0.25');
    expect(cell('position_auc')).toBe('0.43210987654321');
    expect(cell('percent_of_path')).toBe('0.75');
    expect(cell('translation_percent_100m')).toBe('');
    expect(cell('translation_percent_200m')).toBe('3.5');
    expect(cell('rotation_deg_per_100m_200m')).toBe('1');
    expect(lines[2]).toContain('sim3,1,0.1234567890123,');
  });

  it('never writes a formula', () => {
    expect(exportErrors([scored('r1', '=1+1')], 'CSV')).toContain(",'=1+1,");
  });

  it('writes Markdown with the run only if there are several', () => {
    const one = exportErrors([scored('r1', 'x')], 'Markdown').split('\n');
    expect(one[0]).toMatch(/^\| Estimator \| Outcome \| Alignment \| Scale \| Position RMSE \[m\]/);
    expect(one[1]).toMatch(/^\|---\|---\|---\|--:\|/);
    expect(one[2]).toContain(
      '| LOST at 3.1 s, 79 m | init_scale | −2.0000 | 1.500 | 1.479 | 0.250 | 0.750 | – |',
    );
    const two = exportErrors([scored('r1', 'x|y'), scored('r2', 'z')], 'Markdown');
    expect(two).toContain('| Run | Estimator');
    expect(two).toContain('x\\|y');
  });

  it('writes LaTeX with its special characters escaped', () => {
    const text = exportErrors([scored('r1', '50 % a_b'), scored('r2', 'z')], 'LaTeX');
    expect(text).toContain('\\begin{tabular}{llllrrrrrrrrrrrrr}');
    expect(text).toContain(
      '50 \\% a\\_b & feature & LOST at 3.1 s, 79 m & init\\_scale & $-$2.0000',
    );
    expect(text.match(/\\\\\n/g)).toHaveLength(5);
  });

  it('is only a head without scores', () => {
    expect(exportErrors([], 'CSV').split('\n')).toHaveLength(2);
  });
});
