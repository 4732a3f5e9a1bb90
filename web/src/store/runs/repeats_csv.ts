// Repeated flights as a file.
import { csvLine } from '../csv';
import type { Repeats } from './repeats';

/** One line for each flight of each estimator; the box plot is made of these errors. */
export function repeatsCsv(repeats: readonly Repeats[]): string {
  const lines = repeats.flatMap(({ estimator, errors }) =>
    errors.map(({ run, error_m }) => csvLine([estimator, run, error_m])),
  );
  return csvLine(['estimator', 'run', 'position_rmse_m']) + lines.join('');
}
