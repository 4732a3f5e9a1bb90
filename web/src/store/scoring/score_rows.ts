// The table of scores: one row for each estimate and alignment.
import type { Evaluation } from '../../protocol/score_types';
import type { ErrorColumn } from '../errors/error_figures';
import { columnHead, errorColumns, errorCsvValues, kErrorCsvHead } from '../errors/error_figures';
import { kDefaultAlignment } from '../errors/error_table';
import { formatNumber, formatPercent, kNothing } from '../format';
import type { TextFormat } from '../table_text';
import { csvTable, latexTable, markdownTable } from '../table_text';
import { shortName } from './score_desk';

export interface ScoreRow {
  estimate: string;
  /** Index of the estimate, for its colour. */
  index: number;
  alignment: string;
  /** As scoreColumns(); empty if it failed. */
  cells: { text: string; bad: boolean }[];
  /** Warnings, and why values are missing. */
  hints: string[];
  failed: boolean;
}

export function scoreColumns({ estimates }: Evaluation): ErrorColumn[] {
  return errorColumns(estimates.flatMap(({ alignments }) => Object.values(alignments ?? {})));
}

export function scoreRows(evaluation: Evaluation): ScoreRow[] {
  const { estimates } = evaluation;
  const columns = scoreColumns(evaluation);
  return estimates.flatMap(({ name, alignments, warnings, error }, index): ScoreRow[] => {
    const base = { estimate: name, index };
    if (error !== undefined) {
      return [{ ...base, alignment: '', cells: [], hints: [error.message], failed: true }];
    }
    return Object.entries(alignments ?? {}).map(([alignment, errors]) => ({
      ...base,
      alignment,
      cells: columns.map(({ text, bad }) => ({ text: text(errors), bad: bad(errors) })),
      hints: [...(warnings ?? []), errors.degenerate ?? '', errors.error ?? ''].filter(
        (hint) => hint !== '',
      ),
      failed: false,
    }));
  });
}

/** What explains the errors of an estimate: offsets of its clock and of its camera's mount. */
export function offsetTexts({ estimates }: Evaluation): string[] {
  return estimates.flatMap(({ name, offsets }) => {
    const { clock = null, mount = null } = offsets ?? {};
    const share = (explained: number) => formatPercent(explained, 0);
    const texts: string[] = [];
    if (clock !== null) {
      const { time_offset_s, position_rmse_before_m: before, position_rmse_after_m: after } = clock;
      texts.push(
        `${shortName(name)}: its clock is ${formatNumber(Math.abs(time_offset_s) * 1000, 1)} ms ${time_offset_s > 0 ? 'early' : 'late'}, which explains ` +
          `${share(clock.explained)} of the position error after sim3 ` +
          `(RMSE ${formatNumber(before, 3)} m, without it ${formatNumber(after, 3)} m).`,
      );
    }
    if (mount !== null) {
      const { angle_deg, rotation_rmse_before_deg: before, rotation_rmse_after_deg: after } = mount;
      texts.push(
        `${shortName(name)}: a constant rotation of ${formatNumber(angle_deg, 2)} deg explains ` +
          `${share(mount.explained)} of the rotation error after sim3 ` +
          `(RMSE ${formatNumber(before, 3)} deg, without it ${formatNumber(after, 3)} deg).`,
      );
    }
    return texts;
  });
}

export function exportScores(evaluation: Evaluation, format: TextFormat): string {
  const rows = scoreRows(evaluation);
  if (format === 'CSV') {
    const errorsOf = ({ index, alignment }: ScoreRow) =>
      evaluation.estimates[index]?.alignments?.[alignment] ?? {};
    return csvTable(
      ['truth', 'estimate', 'alignment', ...kErrorCsvHead],
      rows.map((row) => [
        evaluation.truth.name,
        row.estimate,
        row.alignment,
        ...errorCsvValues(errorsOf(row)),
      ]),
    );
  }
  const columns = scoreColumns(evaluation);
  const table = {
    head: ['Estimate', 'Alignment', ...columns.map(columnHead)],
    rows: rows.map(({ estimate, alignment, cells, failed }) => [
      shortName(estimate),
      alignment,
      ...(failed ? columns.map(() => kNothing) : cells.map(({ text }) => text)),
    ]),
    numbers: columns.length,
  };
  return format === 'Markdown' ? markdownTable(table) : latexTable(table);
}

/** Alignments that an estimate has, the default first. */
export function scoreAlignments({ estimates }: Evaluation): string[] {
  const modes = new Set(estimates.flatMap(({ alignments }) => Object.keys(alignments ?? {})));
  const others = [...modes].filter((mode) => mode !== kDefaultAlignment).sort();
  return modes.has(kDefaultAlignment) ? [kDefaultAlignment, ...others] : others;
}
