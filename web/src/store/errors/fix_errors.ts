// What an autopilot needs to know of an estimate: the drift between position fixes, and whether the
// covariances that it states are honest.
import type { AlignmentErrors, FixDrift, Nees } from '../../protocol/rest_types';
import type { ErrorColumn } from './error_figures';
import type { ErrorRow } from './error_table';
import { formatNumber, kNothing } from '../format';

/** Distances between fixes that the metrics have [m]. */
export const kFixIntervals_m: readonly number[] = [1000, 2000, 5000];

export const kNeesParts = [
  { part: 'position', label: 'NEES position' },
  { part: 'rotation', label: 'NEES rotation' },
  { part: 'pose', label: 'NEES pose' },
] as const;

const kNeesHint =
  'Mean normalised estimation error squared, and in brackets the band in which it lies with a probability of 95 % if the stated covariances are true';

export const kOverconfident = 'overconfident';

/** Undefined where the path is too short for the interval, and in older runs. */
export function fixDrift(errors: AlignmentErrors, interval_m: number): FixDrift | undefined {
  const found = errors.fix_drift?.find((one) => one.interval_m === interval_m);
  return found?.median_m === undefined ? undefined : found;
}

/** Intervals that the path of any estimate has. */
export function shownFixIntervals_m(errors: readonly AlignmentErrors[]): number[] {
  return kFixIntervals_m.filter((interval_m) =>
    errors.some((error) => fixDrift(error, interval_m) !== undefined),
  );
}

/** Median, and the worst in brackets. */
export function fixDriftText(drift: FixDrift | undefined): string {
  if (drift === undefined) return kNothing;
  return `${formatNumber(drift.median_m, 2)} (${formatNumber(drift.worst_m, 2)})`;
}

/** "3.21 [2.81, 3.20] overconfident" */
export function neesText(nees: Nees | null | undefined): string {
  if (nees === null || nees === undefined) return kNothing;
  const [low, high] = nees.band_95;
  const mark = nees.honesty === 'consistent' ? '' : ` ${nees.honesty}`;
  return `${formatNumber(nees.mean, 2)} [${formatNumber(low, 2)}, ${formatNumber(high, 2)}]${mark}`;
}

function neesHint(nees: Nees | null | undefined): string {
  if (nees === null || nees === undefined) return 'No covariance of it was stated';
  const { samples, degrees, deviation_ratio } = nees;
  return `${samples} poses; ${degrees} is expected. Errors are ${formatNumber(deviation_ratio, 2)} times the stated standard deviations`;
}

function fixDriftOf(interval_m: number): { label: string; unit: string; hint: string } {
  const km = `${interval_m / 1000} km`;
  return {
    label: `Drift between fixes, ${km}`,
    unit: 'm',
    hint: `Position error when the next fix comes, with a fix of position and orientation every ${km}: median, and the worst in brackets`,
  };
}

export function fixRows(errors: readonly AlignmentErrors[]): ErrorRow[] {
  return shownFixIntervals_m(errors).map((interval_m) => {
    const found = errors.map((error) => fixDrift(error, interval_m));
    return {
      key: `fix_drift_${interval_m}m`,
      ...fixDriftOf(interval_m),
      cells: found.map(fixDriftText),
      cellHints: found.map((one) =>
        one === undefined
          ? `The tracked path has no part of ${interval_m / 1000} km`
          : `${one.segments ?? 0} segments, ${one.apart ?? 0} of them without overlap`,
      ),
      bad: found.map(() => false),
    };
  });
}

/** Rows of the parts whose covariance any estimate states. */
export function neesRows(errors: readonly AlignmentErrors[]): ErrorRow[] {
  return kNeesParts.flatMap(({ part, label }) => {
    const found = errors.map((error) => error.consistency?.[part]);
    if (found.every((nees) => nees === null || nees === undefined)) return [];
    return [
      {
        key: `nees_${part}`,
        label,
        unit: '',
        hint: kNeesHint,
        cells: found.map(neesText),
        cellHints: found.map(neesHint),
        bad: found.map((nees) => nees?.honesty === kOverconfident),
      },
    ];
  });
}

/** As columns: only those that any of the errors has. */
export function fixColumns(errors: readonly AlignmentErrors[]): ErrorColumn[] {
  return [
    ...shownFixIntervals_m(errors).map((interval_m) => ({
      key: `fix_drift_${interval_m}m`,
      ...fixDriftOf(interval_m),
      text: (error: AlignmentErrors) => fixDriftText(fixDrift(error, interval_m)),
      bad: () => false,
    })),
    ...kNeesParts
      .filter(({ part }) =>
        errors.some(({ consistency }) => (consistency?.[part] ?? null) !== null),
      )
      .map(({ part, label }) => ({
        key: `nees_${part}`,
        label,
        unit: '',
        hint: kNeesHint,
        text: ({ consistency }: AlignmentErrors) => neesText(consistency?.[part]),
        bad: ({ consistency }: AlignmentErrors) => consistency?.[part]?.honesty === kOverconfident,
      })),
  ];
}

/** Names of the columns of a CSV file with every digit. */
export const kFixCsvHead: readonly string[] = [
  ...kFixIntervals_m.flatMap((interval_m) =>
    ['median', 'worst'].map((what) => `fix_drift_${what}_${interval_m}m`),
  ),
  ...kNeesParts.flatMap(({ part }) =>
    ['', '_low_95', '_high_95'].map((what) => `nees_${part}${what}`),
  ),
  'honesty',
];

export function fixCsvValues(errors: AlignmentErrors): (number | string)[] {
  return [
    ...kFixIntervals_m.flatMap((interval_m) => {
      const drift = fixDrift(errors, interval_m);
      return [drift?.median_m ?? '', drift?.worst_m ?? ''];
    }),
    ...kNeesParts.flatMap(({ part }) => {
      const nees = errors.consistency?.[part];
      return [nees?.mean ?? '', nees?.band_95[0] ?? '', nees?.band_95[1] ?? ''];
    }),
    errors.consistency?.honesty ?? '',
  ];
}
