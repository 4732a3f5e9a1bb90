// The figures of an estimate's errors under one alignment: one list for every table and copy.
import type { AlignmentErrors, Metrics, RelativeError } from '../../protocol/rest_types';
import { fixColumns, fixCsvValues, kFixCsvHead } from './fix_errors';
import { formatNumber, numberOf } from '../format';

export interface Figure {
  key: keyof AlignmentErrors;
  label: string;
  unit: string;
  hint: string;
  digits: number;
}

export const kErrorFigures: readonly Figure[] = [
  { key: 'scale', label: 'Scale', unit: '', hint: 'Metres per unit of the estimate', digits: 4 },
  {
    key: 'position_rmse_m',
    label: 'Position RMSE',
    unit: 'm',
    hint: 'Over tracked frames',
    digits: 3,
  },
  {
    key: 'horizontal_rmse_m',
    label: 'Horizontal',
    unit: 'm',
    hint: 'RMSE of the horizontal part of the position error',
    digits: 3,
  },
  {
    key: 'vertical_rmse_m',
    label: 'Vertical',
    unit: 'm',
    hint: 'RMSE of the height',
    digits: 3,
  },
  {
    key: 'percent_of_path',
    label: 'Of the path',
    unit: '%',
    hint: 'Position RMSE in % of the length of the true path: of the whole flight for runs, from the first to the last match for files',
    digits: 3,
  },
  {
    key: 'position_rmse_hold_m',
    label: 'Position RMSE, held',
    unit: 'm',
    hint: 'Last pose held to the end of the flight',
    digits: 3,
  },
  {
    key: 'rotation_rmse_deg',
    label: 'Rotation RMSE',
    unit: 'deg',
    hint: 'Geodesic angle',
    digits: 3,
  },
  {
    key: 'rotation_euler_norm_rmse_deg',
    label: 'Rotation, Euler norm',
    unit: 'deg',
    hint: 'Norm of the wrapped roll, pitch and yaw errors',
    digits: 3,
  },
  {
    key: 'position_auc',
    label: 'Position AUC',
    unit: '',
    hint: "Area under the curve of the share of the flight's frames whose position error is below a threshold of 0 to 10 m, over 10 m: 1 is the best. Frames without a pose count as errors above it",
    digits: 3,
  },
];

/** The figures that a table of these errors shows: the AUC only where one of them has it. */
export function shownFigures(errors: readonly AlignmentErrors[]): Figure[] {
  return kErrorFigures.filter(
    ({ key }) => key !== 'position_auc' || errors.some((one) => numberOf(one[key]) !== null),
  );
}

/** Lengths of the sub-paths whose errors are shown [m]; the metrics have every hundred to 800 m. */
const kRelativeLengths_m: readonly number[] = [100, 200, 400, 800, 1000, 2000, 5000];
/** Longer ones are shown where the path has them. */
const kAlwaysShown_m = 800;

/** Errors over sub-paths of one length, as in KITTI; undefined if the path is shorter. */
export function relativeError(
  errors: AlignmentErrors,
  length_m: number,
): RelativeError | undefined {
  return errors.relative?.find((one) => one.length_m === length_m);
}

/** The lengths that a table of these errors shows. */
export function shownLengths_m(errors: readonly AlignmentErrors[]): number[] {
  return kRelativeLengths_m.filter(
    (length_m) =>
      length_m <= kAlwaysShown_m || errors.some((error) => relativeError(error, length_m)),
  );
}

/** What the error over sub-paths of a length is called. */
export function driftOf(length_m: number): { label: string; unit: string; hint: string } {
  return {
    label: `Drift in ${length_m} m`,
    unit: '%',
    hint: `Root mean square of the translation error over all sub-paths of ${length_m} m, each aligned at its beginning, in % of its length`,
  };
}

/** The errors of a run's estimate, with the share of the flight's path as in the list of runs. */
export function runErrors(metrics: Metrics, estimator: string, mode: string): AlignmentErrors {
  const errors = metrics.estimators?.[estimator]?.alignments?.[mode] ?? {};
  const path_m = metrics.flight?.path_length_m ?? 0;
  const rmse_m = numberOf(errors.position_rmse_m);
  if (rmse_m === null || !(path_m > 0)) return errors;
  return { ...errors, percent_of_path: (100 * rmse_m) / path_m };
}

/** A figure as a column of a table with one row for each estimate and alignment. */
export interface ErrorColumn {
  key: string;
  label: string;
  unit: string;
  hint: string;
  text: (errors: AlignmentErrors) => string;
  bad: (errors: AlignmentErrors) => boolean;
}

/** Figures, drift by length, and those of fixes and covariances that any of the errors has. */
export function errorColumns(errors: readonly AlignmentErrors[]): ErrorColumn[] {
  return [
    ...shownFigures(errors).map(({ key, label, unit, hint, digits }) => ({
      key,
      label,
      unit,
      hint,
      text: (one: AlignmentErrors) => formatNumber(numberOf(one[key]), digits),
      bad: () => false,
    })),
    ...shownLengths_m(errors).map((length_m) => ({
      key: `relative_${length_m}m`,
      ...driftOf(length_m),
      text: (one: AlignmentErrors) =>
        formatNumber(relativeError(one, length_m)?.translation_percent, 3),
      bad: () => false,
    })),
    ...fixColumns(errors),
  ];
}

/** "Position RMSE [m]" */
export function columnHead({ label, unit }: ErrorColumn): string {
  return unit === '' ? label : `${label} [${unit}]`;
}

/** Names of the columns of a CSV file with every digit. */
export const kErrorCsvHead: readonly string[] = [
  ...kErrorFigures.map(({ key }) => key),
  ...kRelativeLengths_m.flatMap((length_m) => [
    `translation_percent_${length_m}m`,
    `rotation_deg_per_100m_${length_m}m`,
  ]),
  ...kFixCsvHead,
];

export function errorCsvValues(errors: AlignmentErrors): (number | string)[] {
  return [
    ...kErrorFigures.map(({ key }) => numberOf(errors[key]) ?? ''),
    ...kRelativeLengths_m.flatMap((length_m) => {
      const found = relativeError(errors, length_m);
      return [found?.translation_percent ?? '', found?.rotation_deg_per_100m ?? ''];
    }),
    ...fixCsvValues(errors),
  ];
}
