// Documents of the REST interface about studies; server/net/rest/openapi.json is the reference.
import type { Json, JsonObject } from './rest_types';

export type StudyKind = 'explain' | 'predict' | 'hunt';
export type StudyState = 'waiting' | 'running' | 'done' | 'failed' | 'cancelled' | 'interrupted';

export interface StudyProgress {
  share: number;
  text: string;
  spent_s: number;
  left_s: number | null;
}

export interface StudyEntry {
  name: string;
  kind: StudyKind;
  title: string;
  /** Id of the run, or name of the scenario. */
  subject: string;
  estimator: string;
  created_utc: string;
  ended_utc: string | null;
  state: StudyState;
  cancelling: boolean;
  /** Of a waiting study, 1 = next. */
  position: number | null;
  /** Why it failed or was interrupted. */
  problem: string | null;
  progress: StudyProgress | null;
}

export interface StudyRange {
  least: number;
  most: number;
  default: number;
}

export interface StudyCause {
  name: string;
  words: string;
  /** A flight has it or not; the others are properties of every flight. */
  disturbance: boolean;
}

export interface StudyLimits {
  jobs: StudyRange;
  explain: { flights: StudyRange; causes: StudyCause[] };
  predict: { rate_hz: StudyRange; map_km: StudyRange; cell_m: StudyRange };
  hunt: { flights: StudyRange; repeats: StudyRange; axes: StudyRange; seed: StudyRange };
}

export interface StudyList {
  studies: StudyEntry[];
  limits: StudyLimits;
}

export interface Reflight {
  name: string;
  changes: { cause: string; share: number }[];
  seed: number;
  from_s: number;
  to_s: number;
  /** Id of its run. */
  run: string;
  survived: boolean | null;
  outcome: string | null;
  /** From the start of the part. */
  outcome_time_s: number | null;
  initialised_at_s: number | null;
  coverage: number | null;
  texels_per_pixel_median: number;
  error: string | null;
}

export interface Explanation {
  run: string;
  estimator: string;
  outcome: string;
  outcome_time_s: number | null;
  reproduced: boolean;
  reproduced_with_other_seed: boolean | null;
  from_s: number;
  to_s: number;
  sufficient: string[];
  necessary: string[];
  together: string[];
  pair: string[];
  margin: { cause: string; survives_share: number; fails_share: number } | null;
  data_limited: boolean;
  data_reason: string;
  sentences: string[];
  flights: Reflight[];
  untried: { cause: string; reason: string }[];
  /** Causes that were flown without all others; absent in older studies. */
  sufficiency_tested?: string[];
  /** Those of the necessary causes that were found with another seed too; absent in older studies. */
  confirmed?: string[];
  /** Without these it survived, but not with other random numbers; absent in older studies. */
  withdrawn?: string[];
  /** What causes are called. */
  words: Record<string, string>;
}

export interface RiskyStretch {
  from_s: number;
  to_s: number;
  worst_s: number;
  risk_10_s: number;
  reasons: string[];
}

export interface Prediction {
  scenario: string;
  title: string;
  camera: string;
  flight: string;
  duration_s: number;
  length_m: number;
  risk: number | null;
  sentences: string[];
  stretches: RiskyStretch[];
  instants: { t_s: number; risk_10_s: number }[];
  map: JsonObject | null;
  warnings: string[];
}

export interface HuntedFlight {
  values: Record<string, Json>;
  repeat: number;
  seed: number;
  /** Id of its run. */
  run: string;
  outcome: string;
  /** In [-1, 1]; negative = it failed. */
  margin: number;
  failed: boolean;
  failure: string;
  factors: Record<string, number>;
}

export interface HuntResult {
  title: string;
  estimator: string;
  method: string;
  seed: number;
  most_flights: number;
  axes: { name: string; label: string; unit: string }[];
  flights_to_failure: number | null;
  exhausted: boolean;
  cancelled: boolean;
  /** Index of the flight with the lowest margin. */
  worst: number | null;
  flights: HuntedFlight[];
}

/** A study with its result; null before there is one. */
export type StudyShown =
  | { study: StudyEntry & { kind: 'explain' }; result: Explanation | null }
  | { study: StudyEntry & { kind: 'predict' }; result: Prediction | null }
  | { study: StudyEntry & { kind: 'hunt' }; result: HuntResult | null };

/** Whether a study waits or is made. */
export function isOpen({ state }: StudyEntry): boolean {
  return state === 'waiting' || state === 'running';
}
