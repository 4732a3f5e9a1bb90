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

/** Offsets that explain at least half of the mean square error; null = none does. */
export interface ScoredOffsets {
  clock: {
    time_offset_s: number;
    position_rmse_before_m: number;
    position_rmse_after_m: number;
    explained: number;
  } | null;
  mount: {
    angle_deg: number;
    rotation_rmse_before_deg: number;
    rotation_rmse_after_deg: number;
    explained: number;
  } | null;
}

export interface ScoredEstimate {
  name: string;
  poses?: number;
  matched?: number;
  warnings?: string[];
  alignments?: Record<string, AlignmentErrors>;
  offsets?: ScoredOffsets;
  series?: Record<
    string,
    PoseSeries & Record<'axis_errors' | 'errors' | 'scale' | 'relative', SeriesTable>
  >;
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
  find_offsets?: boolean;
}
