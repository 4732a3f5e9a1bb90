// Documents of the REST interface about sweeps; server/net/rest/openapi.json is the reference.
import type { Json, JsonObject } from './rest_types';

export interface SweepAxis {
  name: string;
  label: string;
  unit: string;
  /** Of all cells; empty where the sweep was flown by an older program. */
  values: Json[];
}

export interface SweepProgress {
  passed: number;
  most: number;
  flown: number;
  failed: number;
  /** Null while it is not known. */
  left_s: number | null;
  spent_s: number;
}

export interface SweepEntry {
  name: string;
  title: string;
  description?: string;
  version?: string;
  estimators: string[];
  repeats: number;
  axes: SweepAxis[];
  /** Whether a process works on it. */
  flying: boolean;
  /** What this server does with it; null = nothing. */
  here: 'flying' | 'cancelling' | null;
  /** The border of survival that is sought, or was found; null = every cell is flown. */
  envelope: (BorderSearch & { found: boolean }) | null;
  /** Why its last flight by this server ended early. */
  problem: string | null;
  progress: SweepProgress | null;
  changed_utc: string;
}

export interface SweepSpread {
  flights: number;
  median: number;
  q1: number;
  q3: number;
}

export interface SweepErrors {
  /** Those that count, whether or not the alignment determines their errors. */
  flights: number;
  position_m: SweepSpread | null;
  rotation_deg: SweepSpread | null;
  horizontal_m: SweepSpread | null;
  vertical_m: SweepSpread | null;
  percent_of_path: SweepSpread | null;
}

/** One estimator in one cell. */
export interface SweepRow {
  cell: Record<string, Json>;
  estimator: string;
  baseline: boolean;
  flights: number;
  initialised: number;
  completed: number;
  success_rate_95: [number, number];
  texture_limited: boolean;
  outcomes: Record<string, number>;
  errors: { paper: SweepErrors; sim3: SweepErrors };
  /** Ids of runs. */
  runs: string[];
}

export interface SweepDifference {
  first: string;
  second: string;
  quantity: string;
  cells: number;
  median_difference: number;
  interval_95: [number, number];
  p_adjusted: number;
  verdict: string;
}

export interface SweepTable {
  failed: number;
  unreadable: number;
  rows: SweepRow[];
  conventions: Record<string, { words: string; differences: SweepDifference[] }>;
}

/** How far along an axis an estimator survives is sought, with few flights. */
export interface BorderSearch {
  axis: string;
  estimator: string;
}

export interface Envelope {
  axis: string;
  label: string;
  unit: string;
  estimator: string;
  cells: number;
  cells_needed: number;
  /** null until the border is found. */
  lines:
    | {
        /** Other axis -> value. */
        at: Record<string, Json>;
        /** Last value that survives; null = none does. */
        survives: Json;
        /** Next value, which fails; null = none does. */
        fails: Json;
        /** Survival does not end once. */
        irregular: boolean;
      }[]
    | null;
}

export interface SweepState {
  sweep: SweepEntry;
  /** null = every cell is flown. */
  envelope: Envelope | null;
  /** null before the first flight is over. */
  table: SweepTable | null;
}

/** A sweep file of the server. */
export interface SweepFile {
  name: string;
  title: string;
  description: string;
  /** Why it is no sweep. */
  error: string | null;
}

export interface SweepFiles {
  files: SweepFile[];
  /** Names of files of published errors. */
  published: string[];
  /** Flights at the same time. */
  jobs: { default: number; most: number };
}

/** What is wrong with a sweep's document, or what flying it costs. */
export interface SweepCheck {
  valid: boolean;
  message: string;
  faults: unknown;
  cells: number;
  estimators: number;
  estimator_names: string[];
  /** Axes of which the border of survival can be sought. */
  border_axes: { name: string; label: string }[];
  /** At most. */
  flights: number;
  /** Mean of one flight by the clock on the wall; null = not known. */
  flight_s: number | null;
}

/** A sweep compared with another one, flight by flight. */
export interface SweepComparison {
  pairs: number;
  without_pair: number;
  failed: number;
  quantities: {
    quantity: string;
    /** For which both sweeps have a value. */
    flights: number;
    sweep: number | null;
    baseline: number | null;
  }[];
  conditions: {
    text: string;
    /** true: a failure; null: it cannot be computed, and `problem` says why. */
    holds: boolean | null;
    left: number | null;
    right: number | null;
    problem: string | null;
  }[];
}

export interface ComparisonRequest {
  baseline: string;
  /** Empty: all. */
  estimator: string;
  conditions: string[];
}

export interface SweepStart {
  name: string;
  document: JsonObject;
  jobs: number;
  /** Absent = every cell is flown. */
  border?: BorderSearch;
}
