// Messages of the WebSocket /api/v1/stream; docs/PROTOCOL.md is the contract.
import type { EstimatorStatus, Metrics, Run } from './rest_types';

export const kProtocolVersion = 1;

export type SceneMode = 'chase' | 'orbit' | 'top';

export interface SceneView {
  mode: SceneMode;
  azimuth_deg: number;
  elevation_deg: number;
  distance_m: number;
  follow: boolean;
  width_px: number;
  height_px: number;
}

export interface PictureStream {
  name: string;
  /** Selects one of several cameras; by default the first. */
  camera?: string;
  max_hz?: number;
  quality?: number;
  max_width_px?: number;
}

/** Number of rows that the client already has, by data stream. */
export type Resume = Record<string, number>;

export type ClientMessage =
  | { type: 'attach'; run: string; resume?: Resume }
  | { type: 'detach' }
  | { type: 'subscribe'; streams: PictureStream[] }
  | ({ type: 'view' } & Partial<SceneView>)
  | { type: 'play' }
  | { type: 'pause' }
  | { type: 'seek'; t_ns: number }
  | { type: 'seek'; frame: number }
  | { type: 'step'; frames: number }
  | { type: 'speed'; value: number }
  | { type: 'loop'; value: boolean }
  | { type: 'live' }
  | { type: 'align'; mode: string };

export interface PoseValues {
  x_m: number;
  y_m: number;
  z_m: number;
  roll_deg: number;
  pitch_deg: number;
  yaw_deg: number;
}

export interface EstimateInstant {
  state: string;
  pose: PoseValues | null;
}

export interface Playback {
  t_ns: number;
  frame: number;
  playing: boolean;
  live: boolean;
  speed: number;
  loop: boolean;
  begin_ns: number;
  end_ns: number;
  /** Alignment of the estimates. */
  alignment: string;
  truth: PoseValues | null;
  estimates: Record<string, EstimateInstant>;
}

export type Cell = number | string | boolean | null | string[];

export interface Rows {
  stream: string;
  /** Number of the first row. */
  seq: number;
  columns: Record<string, Cell[]>;
}

export interface StreamInfo {
  id: number;
  name: string;
  camera?: string;
  /** Requested rate. */
  max_hz?: number;
  /** Maximum rate of pictures during a real-time flight. */
  limit_hz?: number;
}

export type ServerMessage =
  | { type: 'hello'; protocol: number; server: string; connection: string }
  | { type: 'ok'; request?: number }
  | { type: 'error'; request?: number; code: string; message: string }
  | { type: 'run'; run: Run }
  | { type: 'streams'; streams: StreamInfo[] }
  | ({ type: 'rows' } & Rows)
  | { type: 'estimators'; estimators: Record<string, EstimatorStatus> }
  | { type: 'metrics'; metrics: Metrics }
  | ({ type: 'playback' } & Playback);
