// The common colour scheme of the 3D view's ribbons, the curves and the table, as in themes.css.
// Canvases need paint().

import type { CurveHue } from '../store/plots/plot_specs';
import { hueOf } from '../store/plots/plot_specs';
import type { TrackColour } from '../store/track_colours';
import type { Track } from '../store/tracks';

const kTruthColour = 'var(--truth)';

/** By the estimator's index in the run. */
const kEstimateColours = [
  'var(--estimate-1)',
  'var(--estimate-2)',
  'var(--estimate-3)',
  'var(--estimate-4)',
  'var(--estimate-5)',
  'var(--estimate-6)',
] as const;

export function estimateColour(index: number): string {
  return cyclic(kEstimateColours, index);
}

/** A colour that the viewer chose, as in a style sheet. */
function chosenColour(colour: TrackColour): string {
  return colour.length === 1 ? estimateColour(Number(colour) - 1) : `#${colour}`;
}

/** The colour of a track in plots and tables. */
export function trackColour(track: Track): string {
  return curveStyle(hueOf(track)).colour;
}

/** Curves of which neither truth nor an estimate is meant. */
const kNeutralColours = ['var(--neutral-1)', 'var(--neutral-2)', 'var(--neutral-3)'] as const;
const kAxisColours = ['var(--axis-x)', 'var(--axis-y)', 'var(--axis-z)'] as const;

// The truth lies below the estimates and stays visible where they agree.
const kTruthWidth_px = 3;
const kCurveWidth_px = 1.25;
/** Of truths by the position of the run; of other curves when the colours begin again. */
const kDashes = [[], [7, 4], [2, 3], [9, 3, 2, 3]] as const;

/** Of an estimate by a second alignment. */
const kSecondDash = [4, 3] as const;

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
        colour: hue.chosen === undefined ? kTruthColour : chosenColour(hue.chosen),
        width_px: hue.order === 0 ? kTruthWidth_px : kTruthWidth_px / 2,
        dash: dashOf(hue.order),
      };
    case 'estimate':
      return {
        ...thin,
        colour: hue.chosen === undefined ? estimateColour(hue.colour) : chosenColour(hue.chosen),
        dash: hue.second === true ? [...kSecondDash] : dashOf(roundOf(hue.colour)),
      };
    case 'run':
      return {
        ...thin,
        colour: cyclic(kNeutralColours, hue.order),
        dash: dashOf(Math.floor(hue.order / kNeutralColours.length)),
      };
    case 'axis':
      return { ...thin, colour: cyclic(kAxisColours, hue.axis) };
  }
}

/** How often the colours have begun again. */
function roundOf(colour: number): number {
  return Math.floor(colour / kEstimateColours.length);
}

function dashOf(round: number): number[] {
  return [...(kDashes[round % kDashes.length] ?? [])];
}

function cyclic(colours: readonly string[], index: number): string {
  return colours[index % colours.length] ?? '';
}

export const kStateColours: Readonly<Record<string, string>> = {
  INITIALISING: 'var(--idle)',
  TRACKING: 'var(--good)',
  LOST: 'var(--bad)',
  CRASHED: 'var(--bad-text)',
};

const kFaults: ReadonlySet<string> = new Set([
  'dropped_frames',
  'frozen_frame',
  'blackout',
  'saturation_burst',
  'dirt',
  'water_drop',
  'stamp_jitter',
  'stamp_offset',
  'gps_outage',
]);

export function faultColour(kind: string): string {
  return `var(--fault-${kFaults.has(kind) ? kind : 'other'})`;
}
