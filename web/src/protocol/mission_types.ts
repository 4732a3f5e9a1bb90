// Documents about worlds and missions; docs/PROTOCOL.md is the contract.
import type { JsonObject } from './rest_types';

export interface WorldEntry {
  /** `builtin:SEED`, `file:NAME` or `scenario:NAME`. */
  name: string;
  title: string;
  /** Value of `world` in a scenario. */
  world: JsonObject;
  /** false: a built-in one that has to be made first. */
  made: boolean;
  /** Names of the scenarios over it. */
  scenarios: string[];
}

export interface LatLon {
  lat_deg: number;
  lon_deg: number;
}

export interface GroundPlace extends LatLon {
  alt_ellipsoid_m: number;
}

export interface World {
  name: string;
  title: string;
  attribution: string;
  world: JsonObject;
  /** Equal for equal files. */
  version: string;
  centre: GroundPlace;
  /** Of the imagery, clockwise. */
  outline: GroundPlace[];
  bounds: { west_deg: number; north_deg: number; east_deg: number; south_deg: number };
  origin: GroundPlace;
  runway: (GroundPlace & { heading_deg: number }) | null;
  /** Height of the geoid at the centre. */
  sea_level_ellipsoid_m: number;
  texel_m: number;
  tile_px: number;
  min_zoom: number;
  max_zoom: number;
}

export interface Heights {
  alt_ellipsoid_m: number[];
  imagery: boolean[];
}

export interface MissionLimits {
  min_clearance_m: number;
  max_bank_deg: number;
  min_overlap: number;
  min_texels_px: number;
  max_motion_px: number;
  min_imagery: number;
  min_start_s: number;
  min_start_baseline: number;
}

export interface MissionRequest {
  document: JsonObject;
  camera?: string;
  overlap_interval_s?: number;
  samples?: number;
  limits?: Partial<MissionLimits>;
}

/** Column by column. */
export interface MissionSamples {
  t_s: number[];
  distance_m: number[];
  lat_deg: number[];
  lon_deg: number[];
  alt_ellipsoid_m: number[];
  ground_ellipsoid_m: number[];
  height_agl_m: number[];
  roll_deg: number[];
  pitch_deg: number[];
  yaw_deg: number[];
  airspeed_m_s: number[];
  ground_speed_m_s: number[];
  climb_m_s: number[];
  /** Number in the mission; null when it is done. */
  item: (number | null)[];
  phase: string[];
  overlap: (number | null)[];
  texels_px: (number | null)[];
  imagery: number[];
  rotation_px: number[];
  translation_px: number[];
}

export interface MissionPlace extends LatLon {
  item: number;
  alt_ellipsoid_m: number;
  ground_ellipsoid_m: number;
  height_agl_m: number;
  height_above_home_m: number;
  reached_s: number | null;
  turn_radius_m: number | null;
  turn_bank_deg: number | null;
}

export interface StartLeg {
  from_s: number;
  to_s: number;
  length_m: number;
  height_agl_m: number;
  /** Length over height. */
  baseline: number;
  enough: boolean;
}

export interface MissionWarning {
  kind: string;
  text: string;
  from_s: number | null;
  to_s: number | null;
  item: number | null;
  /** The worst one, in the unit of the limit. */
  value: number | null;
  limit: number | null;
}

export interface MissionReport {
  end: 'done' | 'landed' | 'hit_ground' | 'time_limit';
  duration_s: number;
  distance_m: number;
  roll_limit_deg: number;
  camera: string;
  samples: MissionSamples;
  items: MissionPlace[];
  /** Corners: latitude, longitude. */
  footprints: { t_s: number; corners: [number, number][] }[];
  start: StartLeg | null;
  warnings: MissionWarning[];
}
