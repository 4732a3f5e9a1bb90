// Plots of scored trajectories over the time of the truth.
import type { Evaluation, SeriesTable } from '../../protocol/score_types';
import { kAxes } from '../run_data';
import type { Curve } from '../plots/curve';
import type { CurveHue, CurveSpec, PlotSpec } from '../plots/plot_specs';
import { kAxisLabels } from '../plots/plot_specs';
import { shortName } from './score_desk';
import type { Span } from '../time_window';

const kErrors = [
  { table: 'errors', column: 'position_m', label: 'Position error', unit: 'm' },
  { table: 'axis_errors', column: 'along_m', label: 'Error along the path', unit: 'm' },
  { table: 'axis_errors', column: 'across_m', label: 'Error to the right', unit: 'm' },
  { table: 'axis_errors', column: 'up_m', label: 'Error up', unit: 'm' },
  { table: 'errors', column: 'rotation_deg', label: 'Rotation error', unit: 'deg' },
] as const;

export type ScoreGroup = 'pose' | 'errors';

export function scoreSpecs(evaluation: Evaluation, mode: string, group: ScoreGroup): PlotSpec[] {
  const { truth, estimates } = evaluation;
  const begin_s = truth.first_s;
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
  return kErrors.map(({ table, column, label, unit }) =>
    plot(
      column,
      label,
      unit,
      3,
      own.map(({ name, tables, hue }) => spec(name, hue, tables[table], column, begin_s)),
    ),
  );
}

/** From the first to the last pose of the truth. */
export function scoreSpan({ truth }: Evaluation): Span {
  const last_s = truth.series?.positions['t_s']?.at(-1) ?? truth.first_s;
  return [0, Math.max(1e-3, last_s - truth.first_s)];
}

function plot(key: string, label: string, unit: string, digits: number, curves: CurveSpec[]) {
  return { key, label, unit, digits, least: unit === 'deg' ? 0.5 : 0.1, curves };
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
