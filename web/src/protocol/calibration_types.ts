// Calibrations over REST (docs/PROTOCOL.md, "Calibrations").

export interface CalibrationSources {
  folders: { name: string; images: number }[];
  recordings: { name: string }[];
  cameras: { name: string }[];
  /** The server can save results. */
  keeps: boolean;
  complete: boolean;
}

export type SourceRequest =
  | { kind: 'folder' | 'camera'; name: string }
  | { kind: 'recording'; name: string; topic?: string }
  | { kind: 'scenario'; name: string; camera?: string; views?: number; seed?: number }
  | { kind: 'upload' };

export interface BoardRequest {
  cols: number;
  rows: number;
  square_m: number;
  markers?: string;
  marker_m?: number;
}

export interface LensRequest {
  model: string;
  k3: boolean;
}

export interface SessionRequest extends LensRequest {
  source: SourceRequest;
  board: BoardRequest;
  accept_symmetric: boolean;
}

/** Pixel centres at integers. */
export type Corner = [number, number];

export interface SearchedImage {
  number: number;
  name: string;
  width_px: number;
  height_px: number;
  /** "taken", or why the image gave no view. */
  verdict: string;
  corners: Corner[];
  /** Whether there is a JPEG of it. */
  picture: boolean;
}

export interface CoverageBar {
  name: string;
  min: number;
  max: number;
  progress: number;
}

export type SessionPhase = 'opening' | 'taking' | 'solving' | 'waiting' | 'failed';

export interface CalibrationSession {
  id: string;
  revision: number;
  source: string;
  uploads: boolean;
  board: BoardRequest;
  phase: SessionPhase;
  error: string | null;
  automatic: boolean;
  source_open: boolean;
  images: number;
  images_total: number | null;
  images_without_view: number;
  without_view: { image: string; reason: string }[];
  newest: SearchedImage | null;
  last_view: SearchedImage | null;
  views: { view: number; name: string; left_out: boolean }[];
  most_views: number;
  coverage: CoverageBar[];
  lens: LensRequest;
  /** Number of the newest estimate. */
  solution: number | null;
  solve_error: string | null;
}

export interface Intrinsics {
  fx_px: number;
  fy_px: number;
  cx_px: number;
  cy_px: number;
  distortion: { model: string; coefficients: number[] };
}

export interface SolvedView {
  view: number;
  image: string;
  rms_px: number;
  max_px: number;
  tilt_deg: number;
  outlier: boolean;
}

export interface CalibrationSolution extends Intrinsics {
  solution: number;
  width_px: number;
  height_px: number;
  standard_deviation: Omit<Intrinsics, 'distortion'> & { coefficients: number[] };
  rms_px: number;
  max_px: number;
  views: SolvedView[];
  warnings: string[];
  /** Of a virtual camera. */
  truth?: Intrinsics;
}

export interface ViewDetail extends SearchedImage {
  view: number;
  /** Of each corner: seen minus projected [px]; null without a part in the estimate. */
  residuals: (Corner | null)[] | null;
}

export interface SavedCalibration {
  name: string;
  file: string;
  error?: string;
  width_px?: number;
  height_px?: number;
  model?: string;
  fx_px?: number;
  rms_px?: number | null;
  views?: number | null;
  source?: string | null;
}

export const kCameraFormats = ['overfly', 'orb-slam2', 'dso', 'svo', 'ros', 'kalibr'] as const;
