// metrics.json made into the error table: one column an estimator, one row a figure.
import type { AlignmentErrors, EstimatorMetrics, Metrics } from '../protocol/rest_types';
import { formatNumber, formatPercent, kNothing } from './format';

export const kDefaultAlignment = 'init_scale';

/** Below this the camera sees less detail than it has pixels: the imagery limits the estimate. */
export const kTextureLimit = 0.5;

export interface ErrorRow {
  key: string;
  label: string;
  unit: string;
  hint: string;
  cells: string[];
}

export interface ErrorTable {
  estimators: { name: string; outcome: string; good: boolean }[];
  rows: ErrorRow[];
}

/** Names of the alignments in the metrics, the paper's first. */
export function alignmentModes(metrics: Metrics | null): string[] {
  const modes = new Set<string>();
  for (const estimator of Object.values(metrics?.estimators ?? {})) {
    for (const mode of Object.keys(estimator.alignments ?? {})) modes.add(mode);
  }
  const rest = [...modes].filter((mode) => mode !== kDefaultAlignment).sort();
  return modes.has(kDefaultAlignment) ? [kDefaultAlignment, ...rest] : rest;
}

export function errorTable(metrics: Metrics, mode: string): ErrorTable {
  const entries = Object.entries(metrics.estimators ?? {});
  const errors = entries.map(([, estimator]) => estimator.alignments?.[mode] ?? {});
  const row = (key: string, label: string, unit: string, hint: string, cells: string[]) => ({
    key,
    label,
    unit,
    hint,
    cells,
  });
  const figure = (key: keyof AlignmentErrors, digits: number) =>
    errors.map((error) => formatNumber(error[key] as number | null | undefined, digits));
  return {
    estimators: entries.map(([name, estimator]) => ({
      name,
      outcome: outcomeText(estimator),
      good: estimator.outcome === 'COMPLETED',
    })),
    rows: [
      row(
        'coverage',
        'Coverage',
        '',
        'Share of the frames that were tracked',
        entries.map(([, estimator]) => formatPercent(estimator.coverage)),
      ),
      row('scale', 'Scale', '', 'Metres per unit of the estimate', figure('scale', 4)),
      row(
        'position_rmse_m',
        'Position RMSE',
        'm',
        'Over tracked frames',
        figure('position_rmse_m', 2),
      ),
      row(
        'position_rmse_hold_m',
        'Position RMSE, held',
        'm',
        'Last pose held to the end of the flight',
        figure('position_rmse_hold_m', 2),
      ),
      row(
        'rotation_rmse_deg',
        'Rotation RMSE',
        'deg',
        'Geodesic angle',
        figure('rotation_rmse_deg', 2),
      ),
      row(
        'rotation_euler_norm_rmse_deg',
        'Rotation, Euler norm',
        'deg',
        'Norm of the wrapped roll, pitch and yaw errors',
        figure('rotation_euler_norm_rmse_deg', 2),
      ),
      row(
        'dropped_frames',
        'Dropped frames',
        '',
        'Frames that the estimator never saw',
        entries.map(([, estimator]) => formatNumber(estimator.dropped_frames, 0)),
      ),
    ],
  };
}

/** Median texels per pixel when it is below the limit, else null. */
export function textureLimited(metrics: Metrics | null): number | null {
  const median = metrics?.camera?.texels_per_pixel?.median;
  return typeof median === 'number' && median < kTextureLimit ? median : null;
}

function outcomeText({ outcome, outcome_time_s }: EstimatorMetrics): string {
  if (outcome === '') return kNothing;
  return typeof outcome_time_s === 'number' && outcome !== 'COMPLETED'
    ? `${outcome} at ${formatNumber(outcome_time_s, 1)} s`
    : outcome;
}
