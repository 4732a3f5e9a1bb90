// Converts metrics.json to the error table: one column per estimator, one row per quantity.
import type { AlignmentErrors, EstimatorMetrics, Metrics, Run } from '../../protocol/rest_types';
import { driftOf, relativeError, runErrors, shownFigures, shownLengths_m } from './error_figures';
import { fixRows, neesRows } from './fix_errors';
import { formatNumber, formatPercent, kNothing, numberOf } from '../format';
import type { WatchedRun } from '../watched_run';

export const kDefaultAlignment = 'init_scale';

/**
 * Below this value the imagery has less detail than the camera has pixels, and limits the estimate.
 */
export const kTextureLimit = 0.5;
const kReportedVoidShare = 0.1;

export interface ErrorRow {
  key: string;
  label: string;
  unit: string;
  hint: string;
  cells: string[];
  /** Explains a cell; empty if there is no explanation. */
  cellHints: string[];
  /** Cells that are marked; absent = those with an explanation. */
  bad?: boolean[];
}

export interface ErrorTable {
  estimators: { name: string; outcome: string; good: boolean }[];
  rows: ErrorRow[];
}

/** Estimators of all runs, to find their alignments. */
export function allMetrics(watched: readonly WatchedRun[]): Metrics {
  const entries = watched.flatMap(({ id, metrics }) =>
    Object.entries(metrics?.estimators ?? {}).map(([name, one]) => [`${id}/${name}`, one] as const),
  );
  return { estimators: Object.fromEntries(entries) };
}

/** Names of the alignments in the metrics; the paper's comes first. */
export function alignmentModes(metrics: Metrics | null): string[] {
  const modes = new Set<string>();
  for (const estimator of Object.values(metrics?.estimators ?? {})) {
    for (const mode of Object.keys(estimator.alignments ?? {})) modes.add(mode);
  }
  const rest = [...modes].filter((mode) => mode !== kDefaultAlignment).sort();
  return modes.has(kDefaultAlignment) ? [kDefaultAlignment, ...rest] : rest;
}

function relativeRows(errors: readonly AlignmentErrors[]): ErrorRow[] {
  return shownLengths_m(errors).map((length_m) => {
    const found = errors.map((error) => relativeError(error, length_m));
    return {
      key: `relative_${length_m}m`,
      ...driftOf(length_m),
      cells: found.map((one) => formatNumber(one?.translation_percent, 3)),
      cellHints: found.map((one) =>
        one === undefined
          ? `The tracked path has no part of ${length_m} m`
          : `${one.pairs} sub-paths; rotation ${formatNumber(one.rotation_deg_per_100m, 4)} deg per 100 m`,
      ),
      bad: found.map(() => false),
    };
  });
}

export function errorTable(
  metrics: Metrics,
  mode: string,
  order: readonly string[] = [],
): ErrorTable {
  const scored = Object.entries(metrics.estimators ?? {});
  scored.sort(([a], [b]) => order.indexOf(a) - order.indexOf(b));
  const names = scored.map(([name]) => name);
  const estimators = scored.map(([, estimator]) => estimator);
  const errors = names.map((name) => runErrors(metrics, name, mode));
  return {
    estimators: estimators.map((estimator, i) => ({
      name: names[i] ?? '',
      outcome: outcomeText(estimator),
      good: estimator.outcome === 'COMPLETED',
    })),
    rows: [
      {
        key: 'coverage',
        label: 'Coverage',
        unit: '',
        hint: 'Tracked frames / all frames of the flight, including dropped and late ones',
        cells: estimators.map(({ coverage }) => formatPercent(coverage)),
        cellHints: [],
      },
      ...shownFigures(errors).map(({ digits, ...row }) => ({
        ...row,
        cells: errors.map((error) => formatNumber(numberOf(error[row.key]), digits)),
        cellHints: errors.map((error) => missingHint(error, row.key)),
      })),
      ...relativeRows(errors),
      ...fixRows(errors),
      ...neesRows(errors),
      {
        key: 'dropped_frames',
        label: 'Dropped frames',
        unit: '',
        hint: 'Frames that the estimator never saw',
        cells: estimators.map(({ dropped_frames }) => formatNumber(dropped_frames, 0)),
        cellHints: [],
      },
    ],
  };
}

/** Tables of several runs as one, next to each other. */
export function joinedTables(tables: readonly ErrorTable[]): ErrorTable {
  return {
    estimators: tables.flatMap(({ estimators }) => estimators),
    rows: rowsOfAny(tables).map((row) => {
      const rows = tables.map((table) => {
        const found = table.rows.find(({ key }) => key === row.key);
        const absent = table.estimators.map(() => kNothing);
        return found ?? { ...row, cells: absent, cellHints: [], bad: absent.map(() => false) };
      });
      return {
        ...row,
        cells: rows.flatMap(({ cells }) => cells),
        cellHints: rows.flatMap(({ cells, cellHints }) => cells.map((_, k) => cellHints[k] ?? '')),
        bad: rows.flatMap((one) => one.cells.map((_, k) => isBad(one, k))),
      };
    }),
  };
}

/** Whether a cell is marked. */
function isBad({ cellHints, bad }: ErrorRow, index: number): boolean {
  return bad === undefined ? (cellHints[index] ?? '') !== '' : bad[index] === true;
}

/** The rows that any of the tables has: some are shown only where a flight has them. */
function rowsOfAny(tables: readonly ErrorTable[]): ErrorRow[] {
  const all: ErrorRow[] = [];
  for (const { rows } of tables) {
    let place = 0;
    for (const row of rows) {
      const known = all.findIndex(({ key }) => key === row.key);
      if (known < 0) all.splice(place, 0, row);
      place = (known < 0 ? place : known) + 1;
    }
  }
  return all;
}

/** The reason why a number is missing, if the metrics contain it. */
function missingHint(error: AlignmentErrors, key: keyof AlignmentErrors): string {
  return numberOf(error[key]) === null ? (error.degenerate ?? '') : '';
}

/** Median over the run of the texels per pixel; null if not known yet. */
export function texelsPerPixel(metrics: Metrics | null): number | null {
  return (
    metrics?.texture?.texels_per_pixel_median ?? metrics?.camera?.texels_per_pixel?.median ?? null
  );
}

/** Whether the imagery, not the camera, limits the run's results. */
export function textureLimited(run: Run | null, metrics: Metrics | null): boolean {
  if (run?.texture_limited === true || metrics?.texture?.texture_limited === true) return true;
  const median = texelsPerPixel(metrics);
  return metrics?.texture === undefined && median !== null && median > 0 && median < kTextureLimit;
}

/** Explains the limitation and how to avoid it. */
export function textureHint(median: number | null): string {
  const found =
    median === null
      ? 'Few texels per pixel'
      : `${formatNumber(median, 2)} texels per pixel (median of the run)`;
  return (
    `${found}: below ${kTextureLimit} the imagery, not the camera, limits the result. ` +
    'The errors say more about the imagery than about the estimators. Fly higher, use a wider ' +
    'field of view or fewer pixels, or give the world finer imagery.'
  );
}

/** Share of the frames that hardly see imagery, if so many that it must be said; else null. */
export function reportedVoidShare(metrics: Metrics | null): number | null {
  const { frames = 0, mostly_void_frames: mostlyVoid = 0 } = metrics?.camera ?? {};
  const share = frames > 0 ? mostlyVoid / frames : 0;
  return share > kReportedVoidShare ? share : null;
}

export function outcomeText(estimator: EstimatorMetrics): string {
  const { outcome, outcome_time_s: time_s, outcome_distance_m: distance_m } = estimator;
  if (outcome === '') return kNothing;
  const relocalised = relocalisedText(estimator);
  const addition = relocalised === '' ? '' : `; ${relocalised}`;
  if (typeof time_s !== 'number' || outcome === 'COMPLETED') return `${outcome}${addition}`;
  const distance = typeof distance_m === 'number' ? `, ${formatNumber(distance_m, 0)} m` : '';
  return `${outcome} at ${formatNumber(time_s, 1)} s${distance}${addition}`;
}

/** Empty if it never found its map again after a loss. */
function relocalisedText({ relocalisations, relocalised_at_s: time_s }: EstimatorMetrics): string {
  const times = relocalisations ?? 0;
  if (times === 0 || typeof time_s !== 'number') return '';
  const count = times === 1 ? '' : ` ${times} times, first`;
  return `found its map again${count} at ${formatNumber(time_s, 1)} s`;
}
