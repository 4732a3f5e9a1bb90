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
