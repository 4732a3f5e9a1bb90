// The errors of all shown runs, estimators and alignments as text: CSV with every digit, Markdown
// and LaTeX with those that the dashboard shows.
import { alignmentModes, kErrorFigures, outcomeText } from './error_table';
import type { AlignmentErrors, EstimatorMetrics } from '../protocol/rest_types';
import { csvLine } from './csv';
import { formatNumber } from './format';
import type { WatchedRun } from './watched_run';

export const kExportFormats = ['Markdown', 'LaTeX', 'CSV'] as const;
export type ExportFormat = (typeof kExportFormats)[number];

interface Entry {
  run: WatchedRun;
  name: string;
  estimator: EstimatorMetrics;
  mode: string;
  errors: AlignmentErrors;
}

/** One row for each estimate and alignment. */
export function exportErrors(watched: readonly WatchedRun[], format: ExportFormat): string {
  const entries = watched.flatMap(entriesOf);
  if (format === 'CSV') return csv(entries);
  const several = watched.length > 1;
  const figures = kErrorFigures.map(({ label, unit }) =>
    unit === '' ? label : `${label} [${unit}]`,
  );
  const head = [...(several ? ['Run'] : []), 'Estimator', 'Outcome', 'Alignment', ...figures];
  const rows = entries.map((entry) => [
    ...(several ? [entry.run.run?.title ?? entry.run.id] : []),
    entry.name,
    outcomeText(entry.estimator),
    entry.mode,
    ...kErrorFigures.map(({ key, digits }) => formatNumber(numberOf(entry.errors[key]), digits)),
  ]);
  return format === 'Markdown' ? markdown(head, rows) : latex(head, rows, kErrorFigures.length);
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
  ]);
  const head = ['run', 'title', 'estimator', 'outcome', 'outcome_time_s', 'coverage', 'alignment'];
  return [[...head, ...keys], ...lines].map(csvLine).join('');
}

function markdown(head: string[], rows: string[][]): string {
  const line = (cells: string[]) =>
    `| ${cells.map((cell) => cell.replaceAll('|', '\\|').replaceAll('\n', ' ')).join(' | ')} |\n`;
  const numbers = head.length - kErrorFigures.length;
  const rule = `|${head.map((_, i) => (i < numbers ? '---|' : '--:|')).join('')}\n`;
  return line(head) + rule + rows.map(line).join('');
}

function latex(head: string[], rows: string[][], numbers: number): string {
  const line = (cells: string[]) => `  ${cells.map(latexText).join(' & ')} \\\\\n`;
  const columns = 'l'.repeat(head.length - numbers) + 'r'.repeat(numbers);
  return (
    `\\begin{tabular}{${columns}}\n  \\hline\n${line(head)}  \\hline\n` +
    `${rows.map(line).join('')}  \\hline\n\\end{tabular}\n`
  );
}

const kLatexNames: Readonly<Record<string, string>> = {
  '\\': '\\textbackslash{}',
  '~': '\\textasciitilde{}',
  '^': '\\textasciicircum{}',
  '−': '$-$',
  '–': '--',
};

function latexText(text: string): string {
  return text.replace(/[\\~^−–&%$#_{}]/g, (found) => kLatexNames[found] ?? `\\${found}`);
}

function numberOf(value: unknown): number | null {
  return typeof value === 'number' ? value : null;
}
