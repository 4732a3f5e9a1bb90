// Numbers of an axis of uPlot, which would write them in the browser's language.
import type uPlot from 'uplot';
import { tickText } from '../../store/plots/path_frame';

export const axisNumbers: uPlot.Axis.DynamicValues = (_plot, splits, _axis, _space, step) =>
  splits.map((value) => tickText(value, step));
