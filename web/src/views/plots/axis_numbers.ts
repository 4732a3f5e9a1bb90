// Numbers of an axis of uPlot, which would write them in the browser's language.
import type uPlot from 'uplot';
import { tickText } from '../../store/plots/path_frame';
import { valueTicks } from '../../store/plots/value_ticks';

export const axisNumbers: uPlot.Axis.DynamicValues = (_plot, splits, _axis, _space, step) =>
  splits.map((value) => tickText(value, step));

/** The axis of the values: uPlot's own steps leave one number in a low plot, or none. */
export const kValueAxis = {
  // Every plot has a step then, from which its height follows.
  space: 1,
  splits: (_plot: uPlot, _axis: number, low: number, high: number, step: number, step_px: number) =>
    valueTicks(low, high, (step_px * (high - low)) / step),
  values: (_plot: uPlot, splits: number[]) =>
    splits.map((value) => tickText(value, (splits[1] ?? 1) - (splits[0] ?? 0))),
} satisfies Pick<uPlot.Axis, 'space' | 'splits' | 'values'>;
