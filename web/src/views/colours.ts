// The common colour scheme of the 3D view's ribbons, the curves and the table.

export const kTruthColour = 'rgb(230, 38, 38)';

/** By the estimator's index in the run. */
const kEstimateColours = [
  'rgb(38, 115, 255)',
  'rgb(26, 184, 89)',
  'rgb(242, 166, 26)',
  'rgb(166, 89, 230)',
  'rgb(26, 191, 204)',
  'rgb(217, 89, 153)',
] as const;

export function estimateColour(index: number): string {
  return kEstimateColours[index % kEstimateColours.length] ?? kEstimateColours[0];
}

export const kStateColours: Readonly<Record<string, string>> = {
  INITIALISING: '#6b7688',
  TRACKING: '#3fb950',
  LOST: '#e5534b',
  CRASHED: '#ff7b72',
};

const kFaultColours: Readonly<Record<string, string>> = {
  dropped_frames: '#ff7b72',
  frozen_frame: '#79c0ff',
  blackout: '#d0d7de',
  saturation_burst: '#f2cc60',
  dirt: '#c08a4e',
  water_drop: '#56d4dd',
  stamp_jitter: '#d2a8ff',
  stamp_offset: '#ff9bce',
  gps_outage: '#7ee787',
};

export function faultColour(kind: string): string {
  return kFaultColours[kind] ?? '#eab766';
}
