// The cells of a sweep as matrices along two of its axes: one for each estimator, and for each value of a
// third axis.
import type { Json } from '../../protocol/rest_types';
import type {
  SweepAxis,
  SweepDifference,
  SweepErrors,
  SweepRow,
  SweepSpread,
  SweepState,
} from '../../protocol/sweep_types';
import { formatNumber, formatPercent, kNothing } from '../format';
import type { SweepPage } from './sweep_page';

export const kSweepFigures = [
  { name: 'outcome', label: 'Outcome', unit: '' },
  { name: 'success', label: 'Success rate', unit: '%' },
  { name: 'sim3_position', label: 'Position RMSE, Sim3', unit: 'm' },
  { name: 'sim3_rotation', label: 'Rotation RMSE, Sim3', unit: 'deg' },
  { name: 'paper_position', label: 'Position RMSE, initial scale', unit: 'm' },
  { name: 'paper_rotation', label: 'Rotation RMSE, initial scale', unit: 'deg' },
] as const;
export type SweepFigure = (typeof kSweepFigures)[number]['name'];

/** One place of a matrix. */
export interface MatrixCell {
  /** Values of all axes as JSON text; names the cell. */
  key: string;
  cell: Record<string, Json>;
  /** undefined = not flown yet. */
  row: SweepRow | undefined;
  text: string;
  hint: string;
  /** How good it is: 1 = best shown, 0 = worst; null = no value. */
  share: number | null;
  /** The estimator did not survive any flight. */
  failed: boolean;
}

export interface Matrix {
  estimator: string;
  baseline: boolean;
  /** Value of the axis whose values have a matrix each, with label and unit; '' = there is none. */
  panel: string;
  rows: MatrixCell[][];
}

export interface Matrices {
  columns: SweepAxis;
  rows: SweepAxis;
  /** The axis whose values have a matrix each; null = none. */
  panels: SweepAxis | null;
  /** Axes that may be `panels`. */
  panelChoices: SweepAxis[];
  /** Other axes with several values, and the chosen one of each as JSON text. */
  others: { axis: SweepAxis; value: string }[];
  /** Those of one estimator follow each other. */
  matrices: Matrix[];
}

/** More matrices next to each other are shown only when asked for. */
const kMostPanels = 8;

const kOneRow: SweepAxis = { name: '', label: '', unit: '', values: [null] };

/** null if the sweep has no cell yet. */
export function matricesOf({ sweep, table }: SweepState, page: SweepPage): Matrices | null {
  const rows = table?.rows ?? [];
  const axes = sweep.axes
    .map((axis) => (axis.values.length > 0 ? axis : { ...axis, values: valuesOf(rows, axis.name) }))
    .filter(({ values }) => values.length > 0);
  const several = axes.filter(({ values }) => values.length > 1);
  const order = [...several, ...axes.filter(({ values }) => values.length === 1)];
  // The axis with most values is the widest.
  const widest = [...order].sort((a, b) => b.values.length - a.values.length)[0];
  if (widest === undefined) return null;
  const columns = order.find(({ name }) => name === page.columns) ?? widest;
  const named = order.find(({ name }) => name === page.rows && name !== columns.name);
  const down = named ?? order.find(({ name }) => name !== columns.name) ?? kOneRow;
  const panelChoices = several.filter(({ name }) => name !== columns.name && name !== down.name);
  const panels = panelsOf(panelChoices, page.panels);
  const others = panelChoices
    .filter((axis) => axis !== panels)
    .map((axis) => {
      const texts = axis.values.map((value) => JSON.stringify(value));
      const wanted = page.fixed[axis.name];
      const value = wanted !== undefined && texts.includes(wanted) ? wanted : (texts[0] ?? '');
      return { axis, value };
    });
  const base: Record<string, Json> = {};
  for (const { name, values } of axes) base[name] = values[0] ?? null;
  for (const { axis, value } of others) base[axis.name] = JSON.parse(value) as Json;

  const known = new Map(rows.map((row) => [`${row.estimator}\n${cellKey(row.cell)}`, row]));
  const names = sweep.estimators.length > 0 ? sweep.estimators : namesOf(rows);
  const limits = figureLimits(rows, page.figure);
  const matrices = names.flatMap((estimator) =>
    (panels?.values ?? [null]).map((panel) => ({
      estimator,
      baseline: rows.some((row) => row.estimator === estimator && row.baseline),
      panel: panels === null ? '' : `${panels.label} ${valueText(panel, panels.unit)}`,
      rows: down.values.map((low) =>
        columns.values.map((value) => {
          const cell = { ...base, [columns.name]: value };
          if (down !== kOneRow) cell[down.name] = low;
          if (panels !== null) cell[panels.name] = panel;
          const key = cellKey(cell);
          return matrixCell(key, cell, known.get(`${estimator}\n${key}`), page.figure, limits);
        }),
      ),
    })),
  );
  return { columns, rows: down, panels, panelChoices, others, matrices };
}

function panelsOf(choices: readonly SweepAxis[], wanted: string | null): SweepAxis | null {
  const named = choices.find(({ name }) => name === wanted);
  if (named !== undefined || wanted === '') return named ?? null;
  return choices.find(({ values }) => values.length <= kMostPanels) ?? null;
}

/** The flights of a cell, one entry for each estimator. */
export function rowsOfCell({ table }: SweepState, key: string): SweepRow[] {
  return (table?.rows ?? []).filter((row) => cellKey(row.cell) === key);
}

/** Numbers are compared as numbers: a file may write 50 or 50.0. */
export function cellKey(cell: Record<string, Json>): string {
  return JSON.stringify(Object.entries(cell).sort(([a], [b]) => (a < b ? -1 : 1)));
}

export function valueText(value: Json, unit: string): string {
  const text = typeof value === 'string' ? value : JSON.stringify(value);
  return unit === '' ? text : `${text} ${unit}`;
}

export function outcomesText(row: SweepRow): string {
  return Object.entries(row.outcomes)
    .map(([outcome, flights]) => (row.flights > 1 ? `${flights} ${outcome}` : outcome))
    .join(', ');
}

/** "feature is better than homography: −0.67 m [−1.48, −0.28], 6 cells" */
export function differenceText(difference: SweepDifference): string {
  const { first, second, quantity, cells, verdict } = difference;
  const unit = quantity.endsWith('_deg') ? 'deg' : 'm';
  const what = quantity.startsWith('rotation') ? 'rotation' : 'position';
  const [low, high] = difference.interval_95;
  const figures = `${significant(difference.median_difference)} ${unit} [${significant(low)}, ${significant(high)}], ${cells} cells`;
  switch (verdict) {
    case 'first_better':
      return `${what}: ${first} is better than ${second}: ${figures}`;
    case 'second_better':
      return `${what}: ${second} is better than ${first}: ${figures}`;
    case 'practically_equal':
      return `${what}: ${first} and ${second} are practically equal: ${figures}`;
    case 'too_few_cells':
      return `${what}: ${first} and ${second} have too few common cells (${cells})`;
    default:
      return `${what}: ${first} and ${second} cannot be told apart: ${figures}`;
  }
}

/** Three significant digits. */
export function significant(value: number): string {
  if (value === 0) return '0';
  const digits = Math.max(0, 2 - Math.floor(Math.log10(Math.abs(value))));
  return formatNumber(value, Math.min(digits, 6));
}

export function spreadText(spread: SweepSpread | null, unit: string): string {
  if (spread === null) return kNothing;
  const median = `${significant(spread.median)} ${unit}`;
  return spread.flights === 1
    ? median
    : `${median} [${significant(spread.q1)}, ${significant(spread.q3)}]`;
}

function valuesOf(rows: readonly SweepRow[], axis: string): Json[] {
  const values = new Map<string, Json>();
  for (const { cell } of rows) {
    const value = cell[axis];
    if (value !== undefined) values.set(JSON.stringify(value), value);
  }
  return [...values.values()].sort((a, b) =>
    typeof a === 'number' && typeof b === 'number'
      ? a - b
      : JSON.stringify(a).localeCompare(JSON.stringify(b)),
  );
}

function namesOf(rows: readonly SweepRow[]): string[] {
  return [...new Set(rows.map(({ estimator }) => estimator))];
}

function errorsOf({ errors }: SweepRow, figure: SweepFigure): SweepErrors | null {
  if (figure === 'outcome' || figure === 'success') return null;
  return figure.startsWith('sim3') ? errors.sim3 : errors.paper;
}

function spreadOf(row: SweepRow, figure: SweepFigure): SweepSpread | null {
  const errors = errorsOf(row, figure);
  if (errors === null) return null;
  return figure.endsWith('position') ? errors.position_m : errors.rotation_deg;
}

/** Logarithms of the least and the greatest error shown. */
function figureLimits(rows: readonly SweepRow[], figure: SweepFigure): [number, number] {
  const logs = rows.flatMap((row) => {
    const median = spreadOf(row, figure)?.median ?? 0;
    return median > 0 ? [Math.log(median)] : [];
  });
  return logs.length === 0 ? [0, 1] : [Math.min(...logs), Math.max(...logs)];
}

function matrixCell(
  key: string,
  cell: Record<string, Json>,
  row: SweepRow | undefined,
  figure: SweepFigure,
  [low, high]: [number, number],
): MatrixCell {
  const empty = { key, cell, row, text: '', hint: 'not flown yet', share: null, failed: false };
  if (row === undefined || row.flights === 0) return empty;
  const rate = row.completed / row.flights;
  const [from, to] = row.success_rate_95;
  const limited = row.texture_limited ? '; the imagery is coarser than the pixels' : '';
  const hint = `${outcomesText(row)}; success ${formatPercent(rate, 0)} [${formatPercent(from, 0)}, ${formatPercent(to, 0)}]${limited}`;
  const made = { key, cell, row, hint, failed: row.completed === 0 };
  if (figure === 'outcome') return { ...made, text: shortOutcome(row), share: rate };
  if (figure === 'success') return { ...made, text: formatNumber(rate * 100, 0), share: rate };
  const spread = spreadOf(row, figure);
  // X: no flight counts; otherwise the alignment does not determine this error.
  if (spread === null) {
    return { ...made, text: errorsOf(row, figure)?.flights === 0 ? 'X' : kNothing, share: null };
  }
  const log = spread.median > 0 ? Math.log(spread.median) : low;
  const share = high > low ? 1 - (log - low) / (high - low) : 1;
  return { ...made, text: significant(spread.median), share };
}

/** The most frequent outcome in few letters. */
function shortOutcome({ outcomes, flights }: SweepRow): string {
  const [most] = Object.entries(outcomes).sort(([, a], [, b]) => b - a);
  if (most === undefined) return '';
  const [name, count] = most;
  const words: Record<string, string> = {
    COMPLETED: 'ok',
    LOST: 'lost',
    RESET: 'reset',
    DIVERGED: 'diverged',
    CRASHED: 'crashed',
    INIT_LATE: 'late',
    NOT_INITIALISED: 'no start',
  };
  const word = words[name] ?? name.toLowerCase();
  return count === flights ? word : `${word} ${count}/${flights}`;
}
