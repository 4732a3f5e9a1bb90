// The errors of all shown runs, estimators and alignments as text: CSV with every digit, Markdown
// and LaTeX with those that the dashboard shows.
import {
  alignmentModes,
  kErrorFigures,
  kRelativeLengths_m,
  outcomeText,
  relativeError,
  shownLengths_m,
} from './error_table';
import type { AlignmentErrors, EstimatorMetrics } from '../protocol/rest_types';
import { fixCsvValues, fixFigures, kFixCsvHead } from './fix_errors';
import { formatNumber, numberOf } from './format';
import type { TextFormat } from './table_text';
import { csvTable, latexTable, markdownTable } from './table_text';
import type { WatchedRun } from './watched_run';

interface Entry {
  run: WatchedRun;
  name: string;
  estimator: EstimatorMetrics;
  mode: string;
  errors: AlignmentErrors;
}

/** One row for each estimate and alignment. */
export function exportErrors(watched: readonly WatchedRun[], format: TextFormat): string {
  const entries = watched.flatMap(entriesOf);
  if (format === 'CSV') return csv(entries);
  const several = watched.length > 1;
  const lengths_m = shownLengths_m(entries.map(({ errors }) => errors));
  const fixes = fixFigures(entries.map(({ errors }) => errors));
  const figures = [
    ...kErrorFigures.map(({ label, unit }) => (unit === '' ? label : `${label} [${unit}]`)),
    ...lengths_m.map((length_m) => `Drift in ${length_m} m [%]`),
    ...fixes.map(({ label, unit }) => (unit === '' ? label : `${label} [${unit}]`)),
  ];
  const head = [...(several ? ['Run'] : []), 'Estimator', 'Outcome', 'Alignment', ...figures];
  const rows = entries.map((entry) => [
    ...(several ? [entry.run.run?.title ?? entry.run.id] : []),
    entry.name,
    outcomeText(entry.estimator),
    entry.mode,
    ...kErrorFigures.map(({ key, digits }) => formatNumber(numberOf(entry.errors[key]), digits)),
    ...lengths_m.map((length_m) =>
      formatNumber(relativeError(entry.errors, length_m)?.translation_percent, 3),
    ),
    ...fixes.map(({ text }) => text(entry.errors)),
  ]);
  const table = { head, rows, numbers: figures.length };
  return format === 'Markdown' ? markdownTable(table) : latexTable(table);
}

function entriesOf(run: WatchedRun): Entry[] {
  return Object.entries(run.metrics?.estimators ?? {}).flatMap(([name, estimator]) =>
    alignmentModes({ estimators: { [name]: estimator } }).map((mode) => {
      const errors = estimator.alignments?.[mode] ?? {};
      return { run, name, estimator, mode, errors };
    }),
  );
}

function csv(entries: Entry[]): string {
  const keys = kErrorFigures.map(({ key }) => key);
  const lines = entries.map(({ run, name, estimator, mode, errors }) => [
    run.id,
    run.run?.title ?? '',
    name,
    estimator.outcome,
    estimator.outcome_time_s ?? '',
    estimator.coverage ?? '',
    mode,
    ...keys.map((key) => numberOf(errors[key]) ?? ''),
    ...kRelativeLengths_m.map(
      (length_m) => relativeError(errors, length_m)?.translation_percent ?? '',
    ),
    ...fixCsvValues(errors),
  ]);
  const head = ['run', 'title', 'estimator', 'outcome', 'outcome_time_s', 'coverage', 'alignment'];
  const drifts = kRelativeLengths_m.map((length_m) => `translation_percent_${length_m}m`);
  return csvTable([...head, ...keys, ...drifts, ...kFixCsvHead], lines);
}
