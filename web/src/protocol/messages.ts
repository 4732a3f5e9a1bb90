// Messages of the WebSocket /api/v1/stream; docs/PROTOCOL.md is the contract.
import type { EstimatorStatus, Metrics, StreamedRun } from './rest_types';

export const kProtocolVersion = 2;

/** What a browser may do: everything, or only look. */
export type Access = 'operator' | 'viewer';

export type SceneMode = 'chase' | 'orbit' | 'top' | 'onboard' | 'free';

export type ScenePart =
  | 'ribbons'
  | 'aircraft'
  | 'frustum'
  | 'footprint'
  | 'points'
  | 'image'
  | 'errors'
  | 'error_history'
  | 'labels';

export interface SceneView {
  mode: SceneMode;
  azimuth_deg: number;
  elevation_deg: number;
  distance_m: number;
  follow: boolean;
  /** Viewpoint of the mode `free`. */
  x_m: number;
  y_m: number;
  z_m: number;
  /** What it shows; all else is off. */
  show: ScenePart[];
  width_px: number;
  height_px: number;
}

/** Where an aircraft is in the picture of a scene. */
export interface SceneLabel {
  run: string;
  /** Absent: the truth. */
  estimator?: string;
  x_px: number;
  y_px: number;
  distance_m: number;
  /** Of an estimate: its distance from the truth. */
  error_m?: number;
}

export interface PictureStream {
  run: string;
  name: string;
  /** Selects one of several cameras; by default the first. */
  camera?: string;
  /** Selects one of several views of the scene. */
  view?: string;
  max_hz?: number;
  quality?: number;
  max_width_px?: number;
  encoding?: 'jpeg' | 'vp8';
  /** Of a scene: index of the first estimator's colour. */
  first_colour?: number;
  /** Of a scene: tracks that it leaves out; '' = the truth. */
  hide?: string[];
  /** Of a scene: colours in place of the usual ones, by track, as #rrggbb. */
  colours?: Record<string, string>;
  /** Of a scene: other runs whose tracks it shows. */
  with?: SceneTracks[];
  /** Of a scene: a second alignment of all estimates, drawn as dashes. */
  compared?: string;
}

/** The tracks of a run in a scene. */
export interface SceneTracks {
  run: string;
  first_colour: number;
  hide?: string[];
  colours?: Record<string, string>;
}

/** Number of rows that the client already has, by data stream. */
export type Resume = Record<string, number>;

/** A part of the clock's time that playback repeats or stops at. */
export interface ClockRange {
  begin_ns: number;
  end_ns: number;
}

export type ClientMessage =
  | { type: 'watch'; run: string; offset_ns?: number; resume?: Resume }
  | { type: 'unwatch'; run: string }
  /** `acknowledge`: the client says which pictures it has shown, so that no more are on the way. */
  | { type: 'subscribe'; pictures: PictureStream[]; acknowledge: boolean }
  | { type: 'shown'; pictures: [stream: number, sequence: number][] }
  | { type: 'key'; id: number }
  | ({ type: 'view'; view?: string } & Partial<SceneView>)
  | { type: 'play' }
  | { type: 'pause' }
  | { type: 'seek'; t_ns: number }
  | { type: 'seek'; frame: number; run?: string }
  | { type: 'step'; frames: number; run?: string }
  | { type: 'speed'; value: number }
  | { type: 'loop'; value: boolean }
  | ({ type: 'range' } & Partial<ClockRange>)
  | { type: 'live' }
  | { type: 'align'; run: string; mode: string };

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

/** A run at the clock's time. */
export interface RunInstant {
  /** Of the run, clamped to what is recorded. */
  t_ns: number;
  frame: number;
  /** Time of the clock at the run's beginning. */
  offset_ns: number;
  /** Of the run. */
  end_ns: number;
  /** Alignment of the estimates. */
  alignment: string;
  truth: PoseValues | null;
  estimates: Record<string, EstimateInstant>;
}

/** The viewer's clock, and every watched run at its time. */
export interface Playback {
  t_ns: number;
  playing: boolean;
  live: boolean;
  /** Negative = backwards. */
  speed: number;
  loop: boolean;
  range: ClockRange | null;
  begin_ns: number;
  end_ns: number;
  /** A watched run still flies. */
  flying: boolean;
  runs: Record<string, RunInstant>;
}

export type Cell = number | string | boolean | null | string[];

export interface Rows {
  run: string;
  stream: string;
  /** Number of the first row. */
  seq: number;
  columns: Record<string, Cell[]>;
}

/** A column of a data stream that can be plotted. */
export interface SeriesInfo {
  stream: string;
  column: string;
  label: string;
  /** Of the values as shown. */
  unit: string;
  /** Series of one group share a plot. */
  group: string;
  /** Shown value = value of the column * scale; by default 1. */
  scale?: number;
}

export interface PictureInfo {
  id: number;
  run: string;
  name: string;
  camera?: string;
  view?: string;
  /** Requested rate. */
  max_hz?: number;
  /** Maximum rate of pictures during a real-time flight. */
  limit_hz?: number;
}

export type ServerMessage =
  /** `access` is absent from older servers, which have operators only. */
  | { type: 'hello'; protocol: number; server: string; connection: string; access?: string }
  | { type: 'ok'; request?: number }
  | {
      type: 'error';
      request?: number;
      code: string;
      message: string;
      run?: string;
      picture?: string;
    }
  | { type: 'run'; run: StreamedRun }
  | { type: 'series'; run: string; series: SeriesInfo[] }
  | { type: 'pictures'; pictures: PictureInfo[]; reduction?: number }
  | { type: 'labels'; id: number; sequence: number; labels: SceneLabel[] }
  | ({ type: 'rows' } & Rows)
  | { type: 'estimators'; run: string; estimators: Record<string, EstimatorStatus> }
  | { type: 'metrics'; run: string; metrics: Metrics }
  | ({ type: 'playback' } & Playback);
