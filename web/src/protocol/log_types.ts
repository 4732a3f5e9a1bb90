// Documents about flight logs; docs/PROTOCOL.md is the contract.

export interface LogEntry {
  /** Unique on the server. */
  name: string;
  /** For `flight.log.file` of a scenario. */
  file: string;
  format: string;
  size_bytes: number;
  uploaded: boolean;
}

export interface LogList {
  logs: LogEntry[];
  complete: boolean;
  uploads: {
    used_bytes: number;
    /** 0: the server takes no uploads. */
    quota_bytes: number;
    max_bytes: number;
  };
}

export interface LogStream {
  name: string;
  vehicle: string;
  messages: number;
  rate_hz: number;
  first_s: number | null;
  last_s: number | null;
  gaps: number;
  longest_gap_s: number;
  /** Only of sources: positions or attitudes. */
  origin?: string;
  positions?: number;
  attitudes?: number;
  invalid_samples?: number;
  georeferenced?: boolean;
  jumps?: number;
  largest_jump_m?: number;
}

export interface LogEvent {
  /** By the vehicle's clock; null if the log has no time for it. */
  t_s: number | null;
  kind: string;
  text: string;
  vehicle?: string;
  /** Of the vehicle's clock, which may start again within the log; only with a time. */
  run?: number;
}

export interface LogInfo {
  name: string;
  format: string;
  size_bytes: number;
  truth: { position: string; attitude: string | null; reason: string } | null;
  on_ground: boolean;
  streams: LogStream[];
  events: LogEvent[];
  warnings: string[];
}

/** Tables, column by column; times by the vehicle's clock. */
export interface LogSeries {
  position_source: string;
  attitude_source: string | null;
  /** Whose clock, and which run of it, the times are. */
  vehicle: string;
  run: number;
  georeferenced: boolean;
  position_count: number;
  attitude_count: number;
  /** lat_deg, lon_deg and a height; or north_m, east_m, above_origin_m. */
  positions: Record<string, number[]>;
  speeds: Record<string, number[]>;
  attitudes: Record<string, number[]>;
  steps: { t_s: number; size_m: number }[];
}

/** Samples minus the smooth motion, column by column; times by the vehicle's clock. */
export type ResidualTable = Record<string, number[]>;

export interface ResidualFit {
  source: string;
  used_count: number;
  shifted_count: number;
  left_out_count: number;
  longest_gap_s: number;
  used: ResidualTable;
  /** After a step, which their residuals contain. */
  shifted: ResidualTable;
  left_out: ResidualTable;
}

export interface LogResiduals {
  /** east_m, north_m, up_m */
  positions: ResidualFit & {
    rms_m: number;
    noise_horizontal_m: number;
    noise_vertical_m: number;
  };
  /** Rotation vectors in body axes: x_deg, y_deg, z_deg */
  attitudes: ResidualFit & { rms_deg: number; noise_deg: number };
  time_offset_s: number;
  /** null: the offset was given. */
  time_offset_sigma_s: number | null;
  jump_count: number;
  jumps: { t_s: number; kind: string; text: string }[];
  warnings: string[];
}

export interface WorkProgress {
  step: string;
  share: number;
}

/** Where the world of a scenario lies. */
export interface WorldExtent {
  name: string;
  attribution: string;
  centre: { lat_deg: number; lon_deg: number };
  /** Of the imagery, clockwise. */
  outline: { lat_deg: number; lon_deg: number }[];
}
