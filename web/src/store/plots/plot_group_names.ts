// The groups of plots over time, as links name them.

export const kPlotGroupNames = [
  'pose',
  'path',
  'errors',
  'drift',
  'estimates',
  'image',
  'sensors',
  'vehicle',
  'estimators',
] as const;
export type PlotGroupName = (typeof kPlotGroupNames)[number];
