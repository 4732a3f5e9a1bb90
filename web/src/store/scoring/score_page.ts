// State of the page that scores trajectories against each other.
import type { LogEntry } from '../../protocol/log_types';
import type { Evaluation, TrajectoryList } from '../../protocol/score_types';
import { kDefaultAlignment } from '../errors/error_table';

export interface ScorePage {
  open: boolean;
  /** null until read. */
  files: TrajectoryList | null;
  /** Flight logs; null until read. */
  logs: LogEntry[] | null;
  listError: string | null;
  /** Name of a trajectory as in docs/PROTOCOL.md. */
  truth: string | null;
  estimates: string[];
  alignment: string;
  /** Figures of every alignment. */
  scores: Evaluation | null;
  /** Poses and errors over time by the chosen alignment. */
  series: Evaluation | null;
  working: boolean;
  error: string | null;
  /** Share of the file that is being uploaded. */
  upload: { name: string; share: number } | null;
}

export function initialScorePage(): ScorePage {
  return {
    open: false,
    files: null,
    logs: null,
    listError: null,
    truth: null,
    estimates: [],
    alignment: kDefaultAlignment,
    scores: null,
    series: null,
    working: false,
    error: null,
    upload: null,
  };
}
