// Plots of scored trajectories: over the time of the truth, seen from above and from the side, and
// errors by the length of the sub-path.
import type { Evaluation, SeriesTable } from '../../protocol/score_types';
import type { Axis } from '../run_data';
import { kAxes } from '../run_data';
import type { Curve } from '../plots/curve';
import type { Path, PathMark } from '../plots/path_frame';
import type { DriftSpec } from '../plots/drift_specs';
import { driftSpecsOf } from '../plots/drift_specs';
import type { CurveHue, CurveSpec, PlotSpec } from '../plots/plot_specs';
import { kAxisLabels } from '../plots/plot_specs';
import { csvLine } from '../csv';
import { lastAtOrBefore } from '../table';
import { shortName } from './score_desk';
import type { Span } from '../playback/time_window';

const kErrors = [
  { table: 'errors', column: 'position_m', label: 'Position error', unit: 'm' },
  { table: 'axis_errors', column: 'along_m', label: 'Error along the path', unit: 'm' },
  { table: 'axis_errors', column: 'across_m', label: 'Error to the right', unit: 'm' },
  { table: 'axis_errors', column: 'up_m', label: 'Error up', unit: 'm' },
  { table: 'errors', column: 'rotation_deg', label: 'Rotation error', unit: 'deg' },
  { table: 'scale', column: 'scale_percent', label: 'Scale error over the last 100 m', unit: '%' },
  {
    table: 'relative',
    column: 'relative_percent',
    label: 'Relative error over the last 100 m',
    unit: '%',
  },
  {
    table: 'relative',
    column: 'relative_deg',
    label: 'Relative rotation over the last 100 m',
    unit: 'deg',
  },
] as const;

export type ScoreGroup = 'pose' | 'path' | 'errors' | 'drift';

export function scoreSpecs(evaluation: Evaluation, mode: string, group: ScoreGroup): PlotSpec[] {
  const { truth, estimates } = evaluation;
  const begin_s = truth.first_s;
  if (group === 'path' || group === 'drift') return [];
  const own = estimates.flatMap(({ name, series }, colour) => {
    const tables = series?.[mode];
    const hue: CurveHue = { kind: 'estimate', colour };
    return tables === undefined ? [] : [{ name: shortName(name), tables, hue }];
  });
  if (group === 'pose') {
    return kAxes.map((axis) => {
      const table = axis.endsWith('_deg') ? 'attitudes' : 'positions';
      const curves = own.map(({ name, tables, hue }) =>
        spec(name, hue, tables[table], axis, begin_s),
      );
      const hue: CurveHue = { kind: 'truth', order: 0 };
      const first = spec('truth', hue, truth.series?.[table], axis, begin_s);
      const angle = axis.endsWith('_deg');
      return plot(axis, kAxisLabels[axis], angle ? 'deg' : 'm', angle ? 2 : 1, [first, ...curves]);
    });
  }
  // Short flights have no errors over 100 m.
  const hasValues = (table: (typeof kErrors)[number]['table']) =>
    own.length === 0 || own.some(({ tables }) => (tables[table].t_s ?? []).length > 0);
  return kErrors
    .filter(({ table }) => hasValues(table))
    .map(({ table, column, label, unit }) =>
      plot(
        column,
        label,
        unit,
        3,
        own.map(({ name, tables, hue }) => spec(name, hue, tables[table], column, begin_s)),
      ),
    );
}

/** Errors by the length of the sub-path (relative pose error, as in KITTI). */
export function scoreDrifts({ estimates }: Evaluation, mode: string): DriftSpec[] {
  const scored = estimates.flatMap(({ name, alignments }, colour) => {
    const relative = alignments?.[mode]?.relative ?? [];
    const hue: CurveHue = { kind: 'estimate', colour };
    return relative.length === 0 ? [] : [{ name: shortName(name), relative, hue }];
  });
  return driftSpecsOf(scored);
}

/** The tracks by an alignment; times are those of the page's clock. */
export function scorePaths(evaluation: Evaluation, mode: string, across: Axis, up: Axis): Path[] {
  const { truth, estimates } = evaluation;
  const path = (name: string, hue: CurveHue, table: SeriesTable | undefined): Path[] => {
    const x = curveOf(table, across, truth.first_s);
    const y = curveOf(table, up, truth.first_s);
    if (x === null || y === null) return [];
    const { t, t_scale_s, t_offset_s } = x;
    return [{ name, hue, x: x.values, y: y.values, t, t_scale_s, t_offset_s }];
  };
  return [
    ...path('truth', { kind: 'truth', order: 0 }, truth.series?.positions),
    ...estimates.flatMap(({ name, series }, colour) =>
      path(shortName(name), { kind: 'estimate', colour }, series?.[mode]?.positions),
    ),
  ];
}

/** All positions of the tracks, one line each; times count from the truth's beginning. */
export function scorePathsCsv({ truth, estimates }: Evaluation, mode: string): string {
  const lines = [csvLine(['track', 't_s', 'x_m', 'y_m', 'z_m'])];
  const add = (name: string, table: SeriesTable | undefined) => {
    const [t_s, ...axes] = ['t_s', 'x_m', 'y_m', 'z_m'].map((column) => table?.[column] ?? []);
    t_s?.forEach((time_s, row) => {
      const place = axes.map((values) => values[row] ?? null);
      if (time_s === null || place.includes(null)) return;
      lines.push(csvLine([name, time_s - truth.first_s, ...(place as number[])]));
    });
  };
  add('truth', truth.series?.positions);
  for (const { name, series } of estimates) add(shortName(name), series?.[mode]?.positions);
  return lines.join('');
}

/** Where the tracks are at a time: of each the last position not later. */
export function pathMarks(paths: readonly Path[], t_s: number): PathMark[] {
  return paths.flatMap(({ hue, x, y, t, t_scale_s, t_offset_s }) => {
    const row = lastAtOrBefore(t, (t_s - t_offset_s) / t_scale_s);
    return row < 0 ? [] : [{ hue, x: x[row] ?? NaN, y: y[row] ?? NaN }];
  });
}

/** From the first to the last pose of the truth. */
export function scoreSpan({ truth }: Evaluation): Span {
  const last_s = truth.series?.positions['t_s']?.at(-1) ?? truth.first_s;
  return [0, Math.max(1e-3, last_s - truth.first_s)];
}

function plot(key: string, label: string, unit: string, digits: number, curves: CurveSpec[]) {
  const angle = unit === 'deg';
  return { key, label, unit, digits, least: angle ? 0.5 : 0.1, unbounded: !angle, curves };
}

function spec(
  name: string,
  hue: CurveHue,
  table: SeriesTable | undefined,
  column: string,
  begin_s: number,
): CurveSpec {
  const curve = curveOf(table, column, begin_s);
  return { name, short: '', hue, curve: () => curve };
}

function curveOf(table: SeriesTable | undefined, column: string, begin_s: number): Curve | null {
  const t = table?.['t_s'];
  const values = table?.[column];
  if (t === undefined || values === undefined || t.length === 0) return null;
  return {
    t: Float64Array.from(t, (value) => value ?? NaN),
    t_scale_s: 1,
    t_offset_s: -begin_s,
    values: Float64Array.from(values, (value) => value ?? NaN),
    scale: 1,
    longest_gap_s: Infinity,
    wraps: kAxes.some((axis) => axis === column) && column.endsWith('_deg'),
  };
}
