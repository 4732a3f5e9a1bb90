// The panels that a layout can contain. views/frame/panel_registry.ts makes them.

export interface PanelEntry {
  title: string;
  /** What it shows. */
  hint: string;
  /** When it is shown again, it joins the first of these that is on the screen. */
  joins: readonly string[];
}

export const kPanels = {
  launcher: {
    title: 'Launch',
    hint: 'Choose a scenario, change its parameters, start a flight',
    joins: ['runs', 'log'],
  },
  runs: { title: 'Runs', hint: 'The runs of the server', joins: ['launcher', 'log'] },
  log: { title: 'Log', hint: 'The log of the run', joins: ['runs', 'launcher', 'status'] },
  scene: { title: '3D view', hint: 'World, aircraft and tracks in 3D', joins: ['camera', 'plots'] },
  plots: { title: 'Over time [s]', hint: 'Curves of every kind over time', joins: ['scene'] },
  'plots-errors': {
    title: 'Errors over time',
    hint: 'Estimates minus truth over time',
    joins: ['plots', 'errors'],
  },
  'plots-image': {
    title: 'Image over time',
    hint: 'Texels per pixel, exposure and saturation over time',
    joins: ['plots', 'camera'],
  },
  plot3d: {
    title: '3D plot',
    hint: 'Tracks in 3D with axes in metres, drawn by the browser',
    joins: ['plots', 'scene'],
  },
  camera: { title: 'Camera', hint: 'The pictures of the aircraft', joins: ['debug', 'scene'] },
  debug: { title: 'Estimator', hint: 'Debug images of an estimator', joins: ['camera', 'scene'] },
  depth: {
    title: 'Depth',
    hint: "Depth of the ground in the camera's image",
    joins: ['debug', 'camera', 'scene'],
  },
  'image-error': {
    title: 'Image error',
    hint: 'What sensor and faults changed in the image, or how far off the view from an estimate is',
    joins: ['depth', 'debug', 'camera'],
  },
  errors: {
    title: 'Errors',
    hint: 'Scores of the estimates',
    joins: ['status', 'debug', 'camera'],
  },
  differences: {
    title: 'Differences',
    hint: 'What differs between the runs shown together: scenario, parameters, program',
    joins: ['errors', 'status', 'plots'],
  },
  repeats: {
    title: 'Repeated flights',
    hint: 'Box plots and histograms of the errors over repeated flights or the runs of a tag',
    joins: ['errors', 'status', 'plots'],
  },
  status: {
    title: 'Estimator status',
    hint: 'State, drops, latency, processor and memory of the estimators',
    joins: ['errors', 'debug', 'plots'],
  },
} as const satisfies Record<string, PanelEntry>;

export type PanelName = keyof typeof kPanels;

export const kPanelNames = Object.keys(kPanels) as PanelName[];

export function isPanelName(value: unknown): value is PanelName {
  return typeof value === 'string' && Object.hasOwn(kPanels, value);
}
