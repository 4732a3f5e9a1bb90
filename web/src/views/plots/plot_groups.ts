// The groups of plots that a panel offers.
import type { PlotGroupName } from '../../store/plots/plot_group_names';
import type { PlotGroup } from '../../store/plots/plot_specs';

export const kGroups = [
  { name: 'pose', label: 'Pose', hint: 'Position and attitude: truth and estimates' },
  { name: 'path', label: 'Path', hint: 'The tracks from above and from the side' },
  { name: 'errors', label: 'Errors', hint: 'Estimates minus truth: position, rotation' },
  { name: 'drift', label: 'Drift', hint: 'Relative errors over the length of sub-paths' },
  { name: 'estimates', label: 'Estimates', hint: 'Latency and counters of the estimators' },
  { name: 'image', label: 'Image', hint: 'Texels per pixel, exposure and saturation' },
  { name: 'sensors', label: 'Sensors', hint: 'IMU, GPS, air data, magnetometer, rangefinder' },
  { name: 'vehicle', label: 'Vehicle', hint: 'Battery, satellites and link of a live vehicle' },
  { name: 'estimators', label: 'Status', hint: 'State, drops, latency, CPU, memory, log' },
] as const satisfies readonly { name: PlotGroupName; label: string; hint: string }[];
export type Group = PlotGroupName;

/** Groups that depend on the alignment of the estimates. */
export const kByAlignment: readonly Group[] = ['pose', 'path', 'errors', 'drift'];

/** Groups that are offered only if a run has their series. */
export const kOptional: readonly PlotGroup[] = ['vehicle'];

/** Groups whose plots have no axis of time. */
export const kUntimed: readonly Group[] = ['path', 'drift'];

export const kNothingYet: Readonly<Record<Exclude<PlotGroup, 'sensors'> | 'drift', string>> = {
  drift: 'No figures yet: they come with the score at the end of the flight, if it is long enough.',
  pose: 'No track is shown.',
  errors: 'No errors yet: they begin with the first pose of an estimator.',
  estimates: 'No values yet: they begin with the first answer of an estimator.',
  image: 'No frames yet.',
  vehicle: 'No live vehicle.',
};
