// One colour scheme: the ribbons in the 3D view, the curves and the table agree.

export const kTruthColour = 'rgb(230, 38, 38)';

/** By the estimator's place in the run. */
const kEstimateColours = [
  'rgb(38, 115, 255)',
  'rgb(255, 166, 26)',
  'rgb(51, 191, 89)',
  'rgb(191, 77, 230)',
] as const;

export function estimateColour(index: number): string {
  return kEstimateColours[index % kEstimateColours.length] ?? kEstimateColours[0];
}

export const kStateColours: Readonly<Record<string, string>> = {
  INITIALISING: '#6b7688',
  TRACKING: '#3fb950',
  LOST: '#e5534b',
};
