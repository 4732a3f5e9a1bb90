// The common colour scheme of the 3D view's ribbons, the curves and the table.

import type { CurveHue } from '../store/plots/plot_specs';
import type { Track } from '../store/tracks';

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
  return cyclic(kEstimateColours, index);
}

/** Curves of which neither truth nor an estimate is meant. */
const kNeutralColours = ['rgb(150, 178, 220)', 'rgb(200, 165, 120)', 'rgb(140, 195, 160)'] as const;
const kAxisColours = ['#ff9288', '#5fd07a', '#79b8ff'] as const;

// The truth lies below the estimates and stays visible where they agree.
const kTruthWidth_px = 3;
const kCurveWidth_px = 1.25;
/** By the position of the run among those that are watched. */
const kDashes = [[], [7, 4], [2, 3], [9, 3, 2, 3]] as const;

export interface CurveStyle {
  colour: string;
  width_px: number;
  dash: number[];
}

export function curveStyle(hue: CurveHue): CurveStyle {
  const thin = { width_px: kCurveWidth_px, dash: [] };
  switch (hue.kind) {
    case 'truth':
      return {
        colour: kTruthColour,
        width_px: hue.order === 0 ? kTruthWidth_px : kTruthWidth_px / 2,
        dash: [...(kDashes[hue.order % kDashes.length] ?? [])],
      };
    case 'estimate':
      return { ...thin, colour: estimateColour(hue.colour) };
    case 'run':
      return { ...thin, colour: cyclic(kNeutralColours, hue.order) };
    case 'axis':
      return { ...thin, colour: cyclic(kAxisColours, hue.axis) };
  }
}

export function trackHue({ name, order, colour }: Track): CurveHue {
  return name === '' ? { kind: 'truth', order } : { kind: 'estimate', colour };
}

function cyclic(colours: readonly string[], index: number): string {
  return colours[index % colours.length] ?? '';
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
