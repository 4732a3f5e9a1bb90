// The errors of all shown runs, estimators and alignments as text: CSV with every digit, Markdown
// and LaTeX with those that the dashboard shows.
import { alignmentModes, outcomeText } from './error_table';
import {
  columnHead,
  errorColumns,
  errorCsvValues,
  kErrorCsvHead,
  runErrors,
} from './error_figures';
import type { AlignmentErrors, EstimatorMetrics } from '../../protocol/rest_types';
import type { TextFormat } from '../table_text';
import { csvTable, latexTable, markdownTable } from '../table_text';
import type { WatchedRun } from '../watched_run';

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
  const columns = errorColumns(entries.map(({ errors }) => errors));
  const texts = [...(several ? ['Run'] : []), 'Estimator', 'Outcome', 'Alignment'];
  const head = [...texts, ...columns.map(columnHead)];
  const rows = entries.map((entry) => [
    ...(several ? [entry.run.run?.title ?? entry.run.id] : []),
    entry.name,
    outcomeText(entry.estimator),
    entry.mode,
    ...columns.map(({ text }) => text(entry.errors)),
  ]);
  const table = { head, rows, numbers: columns.length };
  return format === 'Markdown' ? markdownTable(table) : latexTable(table);
}

function entriesOf(run: WatchedRun): Entry[] {
  const metrics = run.metrics ?? {};
  return Object.entries(metrics.estimators ?? {}).flatMap(([name, estimator]) =>
    alignmentModes({ estimators: { [name]: estimator } }).map((mode) => {
      return { run, name, estimator, mode, errors: runErrors(metrics, name, mode) };
    }),
  );
}

function csv(entries: Entry[]): string {
  const lines = entries.map(({ run, name, estimator, mode, errors }) => [
    run.id,
    run.run?.title ?? '',
    name,
    estimator.outcome,
    estimator.outcome_time_s ?? '',
    estimator.outcome_distance_m ?? '',
    estimator.relocalisations ?? '',
    estimator.relocalised_at_s ?? '',
    estimator.coverage ?? '',
    mode,
    ...errorCsvValues(errors),
  ]);
  const head = [
    'run',
    'title',
    'estimator',
    'outcome',
    'outcome_time_s',
    'outcome_distance_m',
    'relocalisations',
    'relocalised_at_s',
    'coverage',
    'alignment',
  ];
  return csvTable([...head, ...kErrorCsvHead], lines);
}
