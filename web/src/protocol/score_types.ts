// Documents of the REST interface about trajectories and their scores; docs/PROTOCOL.md is the
// contract.
import type { AlignmentErrors } from './rest_types';

export interface TrajectoryFile {
  /** "file:" with folder and path. */
  name: string;
  format: string;
  folder: string;
  size_bytes: number;
  uploaded: boolean;
}

export interface TrajectoryList {
  trajectories: TrajectoryFile[];
  /** false if the list ends at a limit. */
  complete: boolean;
}

/** Columns of equal length; null = unknown. */
export type SeriesTable = Record<string, (number | null)[]>;

export interface PoseSeries {
  positions: SeriesTable;
  attitudes: SeriesTable;
}

export interface ScoredTruth {
  name: string;
  poses: number;
  first_s: number;
  path_m: number;
  warnings: string[];
  series?: PoseSeries;
}

export type ScoredErrors = AlignmentErrors & {
  horizontal_rmse_m?: number | null;
  vertical_rmse_m?: number | null;
  percent_of_path?: number | null;
};

export interface ScoredEstimate {
  name: string;
  poses?: number;
  matched?: number;
  warnings?: string[];
  alignments?: Record<string, ScoredErrors>;
  series?: Record<string, PoseSeries & { axis_errors: SeriesTable; errors: SeriesTable }>;
  /** Why it could not be read or matched. */
  error?: { code: string; message: string };
}

export interface Evaluation {
  truth: ScoredTruth;
  estimates: ScoredEstimate[];
}

export interface EvaluationRequest {
  truth: string;
  estimates: readonly string[];
  alignments: readonly string[];
  points?: number;
}
