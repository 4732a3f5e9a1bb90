// The table of scores: one row for each estimate and alignment.
import type { Evaluation, ScoredErrors } from '../../protocol/score_types';
import { kDefaultAlignment } from '../error_table';
import type { FixFigure } from '../fix_errors';
import { fixCsvValues, fixFigures, kFixCsvHead } from '../fix_errors';
import { formatNumber, formatPercent, numberOf } from '../format';
import type { TextFormat } from '../table_text';
import { csvTable, latexTable, markdownTable } from '../table_text';
import { shortName } from './score_desk';

interface Figure {
  key: keyof ScoredErrors;
  label: string;
  unit: string;
  digits: number;
}

export const kScoreFigures: readonly Figure[] = [
  { key: 'position_rmse_m', label: 'Position RMSE', unit: 'm', digits: 3 },
  { key: 'horizontal_rmse_m', label: 'Horizontal', unit: 'm', digits: 3 },
  { key: 'vertical_rmse_m', label: 'Vertical', unit: 'm', digits: 3 },
  { key: 'percent_of_path', label: 'Of the path', unit: '%', digits: 3 },
  { key: 'rotation_rmse_deg', label: 'Rotation RMSE', unit: 'deg', digits: 3 },
  { key: 'scale', label: 'Scale', unit: '', digits: 4 },
];

export interface ScoreRow {
  estimate: string;
  /** Index of the estimate, for its colour. */
  index: number;
  alignment: string;
  values: (number | null)[];
  /** As scoreFixFigures(). */
  extras: { text: string; bad: boolean }[];
  /** Warnings, and why values are missing. */
  hints: string[];
  failed: boolean;
}

/** Drift between position fixes and honesty, where any estimate has them. */
export function scoreFixFigures({ estimates }: Evaluation): FixFigure[] {
  return fixFigures(estimates.flatMap(({ alignments }) => Object.values(alignments ?? {})));
}

export function scoreRows(evaluation: Evaluation): ScoreRow[] {
  const { estimates } = evaluation;
  const figures = scoreFixFigures(evaluation);
  return estimates.flatMap(({ name, alignments, warnings, error }, index): ScoreRow[] => {
    const base = { estimate: name, index };
    if (error !== undefined) {
      const none = kScoreFigures.map(() => null);
      const hints = [error.message];
      return [{ ...base, alignment: '', values: none, extras: [], hints, failed: true }];
    }
    return Object.entries(alignments ?? {}).map(([alignment, errors]) => ({
      ...base,
      alignment,
      values: kScoreFigures.map(({ key }) => numberOf(errors[key])),
      extras: figures.map(({ text, bad }) => ({ text: text(errors), bad: bad(errors) })),
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
    const keys = kScoreFigures.map(({ key }) => key);
    const errorsOf = ({ index, alignment }: ScoreRow) =>
      evaluation.estimates[index]?.alignments?.[alignment] ?? {};
    return csvTable(
      ['truth', 'estimate', 'alignment', ...keys, ...kFixCsvHead],
      rows.map((row) => [
        evaluation.truth.name,
        row.estimate,
        row.alignment,
        ...row.values.map((value) => value ?? ''),
        ...fixCsvValues(errorsOf(row)),
      ]),
    );
  }
  const figures = [...kScoreFigures, ...scoreFixFigures(evaluation)];
  const labels = figures.map(({ label, unit }) => (unit === '' ? label : `${label} [${unit}]`));
  const table = {
    head: ['Estimate', 'Alignment', ...labels],
    rows: rows.map(({ estimate, alignment, values, extras }) => [
      shortName(estimate),
      alignment,
      ...values.map((value, i) => formatNumber(value, kScoreFigures[i]?.digits ?? 3)),
      ...extras.map(({ text }) => text),
    ]),
    numbers: labels.length,
  };
  return format === 'Markdown' ? markdownTable(table) : latexTable(table);
}

/** Alignments that an estimate has, the default first. */
export function scoreAlignments({ estimates }: Evaluation): string[] {
  const modes = new Set(estimates.flatMap(({ alignments }) => Object.keys(alignments ?? {})));
  const others = [...modes].filter((mode) => mode !== kDefaultAlignment).sort();
  return modes.has(kDefaultAlignment) ? [kDefaultAlignment, ...others] : others;
}
