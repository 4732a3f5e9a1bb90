// State of the page of sweeps.
import type { SweepEntry, SweepState } from '../../protocol/sweep_types';
import type { SweepFormState } from './sweep_form';
import type { SweepFigure } from './sweep_matrix';
import type { SweepResultsState } from './sweep_results';
import { initialSweepResults } from './sweep_results';

export interface SweepPage {
  open: boolean;
  /** null until read. */
  sweeps: SweepEntry[] | null;
  name: string | null;
  /** null until read. */
  shown: SweepState | null;
  figure: SweepFigure;
  /** Names of the axes along the columns and rows; null = chosen by the page. */
  columns: string | null;
  rows: string | null;
  /** Name of the axis whose values have matrices next to each other; '' = none, null = chosen by the page. */
  panels: string | null;
  /** Values of the other axes, as JSON text. */
  fixed: Record<string, string>;
  /** The cell whose flights are listed, as JSON text. */
  cell: string | null;
  error: string | null;
  results: SweepResultsState;
  /** A sweep that is being prepared; null = none. */
  form: SweepFormState | null;
}

export function initialSweepPage(): SweepPage {
  return {
    open: false,
    sweeps: null,
    name: null,
    shown: null,
    figure: 'outcome',
    columns: null,
    rows: null,
    panels: null,
    fixed: {},
    cell: null,
    error: null,
    results: initialSweepResults(),
    form: null,
  };
}
