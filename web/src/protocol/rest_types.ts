// Documents of the REST interface under /api/v1; docs/PROTOCOL.md is the contract.

export type RunStatus =
  | 'queued'
  | 'running'
  | 'completed'
  | 'failed'
  | 'cancelled'
  | 'interrupted'
  | 'unreadable';

/** How one estimator performed. */
export interface EstimatorResult {
  estimator: string;
  outcome: string;
  /** Of alignment init_scale; null if the estimate could not be aligned. */
  position_rmse_m: number | null;
  /** Of the path. */
  position_rmse_percent: number | null;
}

/** What differs between runs. */
export interface Differences {
  runs: string[];
  /** `values`: one for each run; null = absent. */
  fields: { field: string; values: (string | null)[] }[];
  /** Fields beyond the server's limit. */
  left_out: number;
}

/** A run in the stream's messages. */
export type StreamedRun = Omit<Run, 'results' | 'tags' | 'note'>;

export interface Run {
  id: string;
  scenario: string;
  title: string;
  status: RunStatus;
  created_utc: string;
  error: string | null;
  /** Invalid file and field of the run's folder. */
  problem: string | null;
  duration_ns: number;
  frames: number;
  frames_total: number;
  pacing: string;
  estimators: string[];
  /** What is flown, for people: airspeed, height, ...; '' = not known yet. */
  flight: string;
  seed: number;
  attribution: string;
  /** The imagery, not the camera, limits the result. */
  texture_limited: boolean;
  /** Empty until the run is scored. */
  results: EstimatorResult[];
  /** Written by people. */
  tags: string[];
  /** Likewise. */
  note: string;
  /** Of a waiting run, 1 = next. */
  queue_position: number | null;
  /** Time until a flying run ends, as far as it is known. */
  left_s: number | null;
  /** The step in progress before the first frame. */
  notice: string | null;
  /** Files of the run's world that have changed since the flight. */
  world_change: string | null;
}

/** One camera of a run, as listed in its manifest. */
export interface CameraInfo {
  name: string;
  width_px: number;
  height_px: number;
  distortion?: { model: string } | null;
}

export interface Manifest {
  cameras?: CameraInfo[];
  /** With the camera whose images each gets. */
  estimators?: { name: string; camera?: string }[];
}

export interface ScenarioEntry {
  name: string;
  title: string;
  description: string;
  /** Why it cannot be flown on this machine; null if it can. */
  error: string | null;
  /** Its kind: course, mission, log, ...; '' = it cannot be read. */
  flight: string;
  /** By a viewer: it can be replaced and deleted. */
  saved: boolean;
}

/** Any JSON value: scenario documents are read by path, not by type. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
export type JsonObject = Record<string, Json>;

/** Errors over the sub-paths of one length. */
export interface RelativeError {
  length_m: number;
  pairs: number;
  translation_percent: number;
  rotation_deg_per_100m: number;
}

/** How far off the estimate is when the next position fix comes, with one every interval_m. */
export interface FixDrift {
  interval_m: number;
  /** Why there is none; absent with the figures. */
  unavailable?: string;
  segments?: number;
  /** Segments that fit into the path without overlap. */
  apart?: number;
  median_m?: number;
  worst_m?: number;
}

/** Normalised estimation error squared: errors against the covariances that were stated. */
export interface Nees {
  /** The mean that is expected. */
  degrees: number;
  samples: number;
  mean: number;
  band_95: [number, number];
  /** Errors / stated standard deviations. */
  deviation_ratio: number;
  honesty: string;
}

export interface Consistency {
  position: Nees | null;
  rotation: Nees | null;
  pose: Nees | null;
  honesty: string | null;
}

/** Errors of one estimate under one alignment; null if not available. */
export interface AlignmentErrors {
  relative?: RelativeError[];
  fix_drift?: FixDrift[];
  /** Absent where no covariance was stated. */
  consistency?: Consistency;
  scale?: number | null;
  position_rmse_m?: number | null;
  horizontal_rmse_m?: number | null;
  vertical_rmse_m?: number | null;
  /** Only of evaluations: metrics have the flight's path instead. */
  percent_of_path?: number | null;
  rotation_rmse_deg?: number | null;
  position_rmse_hold_m?: number | null;
  /** Share of 1; absent in older runs, null where the frames of the flight are not known. */
  position_auc?: number | null;
  rotation_euler_norm_rmse_deg?: number | null;
  /**
   * The reason why the positions do not determine the rotation; there are then no rotation errors.
   */
  degenerate?: string | null;
  /** The reason why this alignment has no errors. */
  error?: string | null;
  /** Transforms the estimate to the world; absent in older runs. */
  S_world_vo?: object | null;
}

export interface EstimatorMetrics {
  outcome: string;
  outcome_time_s?: number | null;
  /** True path flown until then; absent in older runs. */
  outcome_distance_m?: number | null;
  /** How often it found its map again after a loss; absent in older runs. */
  relocalisations?: number | null;
  /** Time of the first one in the flight. */
  relocalised_at_s?: number | null;
  coverage?: number | null;
  alignments?: Record<string, AlignmentErrors>;
  dropped_frames?: number | null;
}

export interface Metrics {
  flight?: { duration_s?: number; path_length_m?: number };
  estimators?: Record<string, EstimatorMetrics>;
  camera?: {
    frames?: number;
    /** More than half of the image is without imagery; missing if there are none. */
    mostly_void_frames?: number;
    texels_per_pixel?: { min?: number | null; median?: number | null };
  };
  texture?: {
    texels_per_pixel_median?: number | null;
    texels_per_pixel_min?: number | null;
    texture_limited?: boolean;
  };
}

export interface LatencySummary {
  median: number;
  p95: number;
  p99: number;
  max: number;
}

export interface EstimatorUse {
  cpu_s: number;
  /** Of one processor. */
  cpu_percent: number;
  /** null if not known. */
  peak_memory_mb: number | null;
  /** own_account: its threads in the server, and the memory that it reports. */
  measured: 'process' | 'own_account' | 'calling_thread';
}

/** Status of an estimator in its run. */
export interface EstimatorStatus {
  /** STARTING, a tracking state, or CRASHED. */
  state: string;
  /** The reason why it ended. */
  crash: string | null;
  answered: number;
  dropped: number;
  unanswered: number;
  hashes_compared: number;
  hash_mismatches: number;
  latency_ms: LatencySummary | null;
  resources: EstimatorUse | null;
}

export function isActive(run: Run): boolean {
  return run.status === 'queued' || run.status === 'running';
}
