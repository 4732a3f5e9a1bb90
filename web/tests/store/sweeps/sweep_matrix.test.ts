import { describe, expect, it } from 'vitest';
import type { SweepErrors, SweepRow, SweepState } from '../../../src/protocol/sweep_types';
import {
  differenceText,
  matricesOf,
  rowsOfCell,
  significant,
} from '../../../src/store/sweeps/sweep_matrix';
import type { SweepFigure } from '../../../src/store/sweeps/sweep_matrix';
import { initialSweepPage } from '../../../src/store/sweeps/sweep_page';

const spread = (median: number) => ({ flights: 1, median, q1: median, q3: median });

function errors(position_m: number | null): SweepErrors {
  return {
    flights: position_m === null ? 0 : 1,
    position_m: position_m === null ? null : spread(position_m),
    rotation_deg: null,
    horizontal_m: null,
    vertical_m: null,
    percent_of_path: null,
  };
}

function row(
  cell: SweepRow['cell'],
  estimator: string,
  completed: number,
  position_m: number | null,
  fields: Partial<SweepRow> = {},
): SweepRow {
  return {
    cell,
    estimator,
    baseline: estimator === 'hold',
    flights: 1,
    initialised: 1,
    completed,
    success_rate_95: completed === 1 ? [0.2, 1] : [0, 0.8],
    texture_limited: false,
    outcomes: completed === 1 ? { COMPLETED: 1 } : { LOST: 1 },
    errors: { sim3: errors(position_m), paper: errors(position_m) },
    runs: [`s.${estimator}`],
    ...fields,
  };
}

function state(rows: SweepRow[], values: { h: number[]; v: number[]; air: string[] }): SweepState {
  return {
    sweep: {
      name: 's',
      title: '',
      estimators: ['feature', 'hold'],
      repeats: 1,
      axes: [
        { name: 'v', label: 'Airspeed', unit: 'm/s', values: values.v },
        { name: 'h', label: 'Height', unit: 'm', values: values.h },
        { name: 'air', label: 'air', unit: '', values: values.air },
      ],
      flying: false,
      here: null,
      envelope: null,
      problem: null,
      progress: null,
      changed_utc: '2026-11-25T00:00:00Z',
    },
    envelope: null,
    table: { failed: 0, unreadable: 0, rows, conventions: {} },
  };
}

const planned = { h: [50, 100, 150], v: [10, 25], air: ['calm', 'gusts'] };
const flown = [
  row({ v: 10, h: 50, air: 'calm' }, 'feature', 1, 0.1),
  row({ air: 'calm', h: 100, v: 10 }, 'feature', 0, null),
  row({ v: 25, h: 50, air: 'calm' }, 'feature', 1, 10),
  row({ v: 10, h: 50, air: 'gusts' }, 'feature', 0, 3),
];

describe('matricesOf', () => {
  it('puts the axis with most values along the columns, and the third side by side', () => {
    const made = matricesOf(state(flown, planned), initialSweepPage());
    expect(made?.panels?.name).toBe('air');
    expect(made?.others).toEqual([]);
    expect(made?.matrices.map(({ estimator, panel }) => [estimator, panel])).toEqual([
      ['feature', 'air calm'],
      ['feature', 'air gusts'],
      ['hold', 'air calm'],
      ['hold', 'air gusts'],
    ]);
    const texts = made?.matrices.map(({ rows }) => rows.flat().map(({ text }) => text));
    expect(texts?.slice(0, 2)).toEqual([
      ['ok', 'lost', '', 'ok', '', ''],
      ['lost', '', '', '', '', ''],
    ]);
  });

  it('has one matrix for each estimator where no axis is wanted side by side, and fixes the third', () => {
    const made = matricesOf(state(flown, planned), { ...initialSweepPage(), panels: '' });
    expect(made?.panels).toBeNull();
    expect(made?.panelChoices.map(({ name }) => name)).toEqual(['air']);
    expect(made?.columns.name).toBe('h');
    expect(made?.rows.name).toBe('v');
    expect(made?.others.map(({ axis, value }) => [axis.name, value])).toEqual([['air', '"calm"']]);
    expect(made?.matrices.map(({ estimator }) => estimator)).toEqual(['feature', 'hold']);
    const texts = made?.matrices[0]?.rows.map((cells) => cells.map(({ text }) => text));
    expect(texts).toEqual([
      ['ok', 'lost', ''],
      ['ok', '', ''],
    ]);
    expect(made?.matrices[0]?.rows[0]?.[2]?.hint).toBe('not flown yet');
    expect(made?.matrices[0]?.rows[0]?.[1]?.failed).toBe(true);
  });

  it('follows the choice of axes and of the fixed value', () => {
    const page = {
      ...initialSweepPage(),
      columns: 'v',
      rows: 'h',
      panels: '',
      fixed: { air: '"gusts"' },
    };
    const made = matricesOf(state(flown, planned), page);
    const texts = made?.matrices[0]?.rows.map((cells) => cells.map(({ text }) => text));
    expect(texts).toEqual([
      ['lost', ''],
      ['', ''],
      ['', ''],
    ]);
  });

  it('shows many values side by side only when asked for', () => {
    const air = Array.from({ length: 9 }, (_, i) => `a${i}`);
    const values = { h: Array.from({ length: 10 }, (_, i) => i), v: [10, 25], air };
    const page = { ...initialSweepPage(), columns: 'h', rows: 'v' };
    expect(matricesOf(state(flown, values), page)?.panels).toBeNull();
    const asked = matricesOf(state(flown, values), { ...page, panels: 'air' });
    expect(asked?.matrices).toHaveLength(2 * 9);
  });

  it('shades errors between the least and the greatest, and marks with X what has none', () => {
    const page = { ...initialSweepPage(), panels: '', figure: 'sim3_position' as const };
    const made = matricesOf(state(flown, planned), page);
    const cells = made?.matrices[0]?.rows.flat() ?? [];
    expect(cells.map(({ text }) => text)).toEqual(['0.100', 'X', '', '10.0', '', '']);
    expect(cells[0]?.share).toBeCloseTo(1);
    expect(cells[1]?.share).toBeNull();
    expect(cells[3]?.share).toBeCloseTo(0);
  });

  it('shows X only where no flight counts', () => {
    const page = { ...initialSweepPage(), panels: '', figure: 'paper_rotation' as const };
    // Lost flights on a straight path count, but the alignment does not determine their rotation.
    const straight = { paper: errors(1), sim3: errors(null) };
    const rows = [row({ h: 50 }, 'feature', 0, null, { errors: straight })];
    const texts = (figure: SweepFigure) =>
      matricesOf(state(rows, { h: [50], v: [], air: [] }), { ...page, figure })
        ?.matrices[0]?.rows.flat()
        .map(({ text }) => text);
    expect(texts('paper_rotation')).toEqual(['–']);
    expect(texts('paper_position')).toEqual(['1.00']);
    expect(texts('sim3_rotation')).toEqual(['X']);
  });

  it('takes the values of what was flown where the sweep does not tell them', () => {
    const made = matricesOf(state(flown, { h: [], v: [], air: [] }), initialSweepPage());
    expect(made?.columns.values).toHaveLength(2);
    expect(made?.rows.values).toHaveLength(2);
    expect(matricesOf(state([], { h: [], v: [], air: [] }), initialSweepPage())).toBeNull();
  });

  it('shows a sweep with one axis in one row', () => {
    const one = state([row({ h: 50 }, 'feature', 1, 1)], { h: [50, 100], v: [], air: [] });
    const made = matricesOf(one, initialSweepPage());
    expect(made?.rows.name).toBe('');
    expect(made?.matrices[0]?.rows.map((cells) => cells.map(({ text }) => text))).toEqual([
      ['ok', ''],
    ]);
  });

  it('counts repeats', () => {
    const repeated = row({ h: 50 }, 'feature', 2, 1, {
      flights: 3,
      outcomes: { COMPLETED: 2, NOT_INITIALISED: 1 },
    });
    const shown = state([repeated], { h: [50, 100], v: [], air: [] });
    const text = (figure: SweepFigure) =>
      matricesOf(shown, { ...initialSweepPage(), figure })?.matrices[0]?.rows[0]?.[0]?.text;
    expect(text('outcome')).toBe('ok 2/3');
    expect(text('success')).toBe('67');
  });
});

describe('rowsOfCell', () => {
  it('finds the flights whatever the order of the fields', () => {
    const shown = state(flown, planned);
    const made = matricesOf(shown, initialSweepPage());
    const key = made?.matrices[0]?.rows[0]?.[1]?.key ?? '';
    expect(rowsOfCell(shown, key).map(({ outcomes }) => outcomes)).toEqual([{ LOST: 1 }]);
  });
});

describe('texts', () => {
  it('has three significant digits', () => {
    expect([0, 0.012345, 1.2345, 12.345, 1234.5].map(significant)).toEqual([
      '0',
      '0.0123',
      '1.23',
      '12.3',
      '1235',
    ]);
  });

  it('says which estimator is better', () => {
    const difference = {
      first: 'feature',
      second: 'hold',
      quantity: 'position_m',
      cells: 6,
      median_difference: -1.5,
      interval_95: [-2, -1] as [number, number],
      p_adjusted: 0.001,
    };
    expect(differenceText({ ...difference, verdict: 'first_better' })).toBe(
      'position: feature is better than hold: −1.50 m [−2.00, −1.00], 6 cells',
    );
    expect(differenceText({ ...difference, verdict: 'too_few_cells', cells: 2 })).toBe(
      'position: feature and hold have too few common cells (2)',
    );
  });
});
