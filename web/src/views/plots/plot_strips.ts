// The two groups of plots: poses of truth and estimates, and properties of the camera's image.
import { kTextureLimit } from '../../store/error_table';
import { wrapDegrees } from '../../store/format';
import type { Axis, ImageColumn } from '../../store/run_data';
import { kAxes } from '../../store/run_data';
import { EstimateCurve, isAngle, TruthCurve } from '../../store/series';
import { shownEstimate } from '../../store/state';
import type { State } from '../../store/state';
import type { Span } from '../../store/time_window';
import { estimateColour, kTruthColour } from '../colours';
import type { PlotOptions } from './plot';
import { Plot } from './plot';

export type PlotActions = Pick<PlotOptions, 'onSeek' | 'onHover' | 'onZoom'>;

export interface Strip {
  readonly plot: Plot;
  draw(state: State, t_s: Float64Array, span_s: Span): void;
  /** Values at the playback cursor; @param row  of its frame */
  showCursor(state: State, row: number): void;
  /** Values at the time under the mouse; @param row  of the frame nearest to it */
  showHover(state: State, t_s: number, row: number): void;
}

const kAxisLabels: Record<Axis, string> = {
  x_m: 'x east',
  y_m: 'y north',
  z_m: 'z up',
  roll_deg: 'Roll',
  pitch_deg: 'Pitch',
  yaw_deg: 'Yaw',
};

export function poseStrips(estimators: readonly string[], actions: PlotActions): Strip[] {
  return kAxes.map((axis, index) => new PoseStrip(axis, index, estimators, actions));
}

class PoseStrip implements Strip {
  readonly plot: Plot;
  private readonly truth: TruthCurve;
  private readonly estimates: EstimateCurve[];

  constructor(
    private readonly axis: Axis,
    index: number,
    private readonly names: readonly string[],
    actions: PlotActions,
  ) {
    this.truth = new TruthCurve(axis);
    this.estimates = names.map(() => new EstimateCurve(axis));
    const angle = isAngle(axis);
    this.plot = new Plot({
      ...actions,
      key: axis,
      label: kAxisLabels[axis],
      unit: angle ? 'deg' : 'm',
      digits: angle ? 2 : 1,
      least: angle ? 4 : 2,
      colours: [kTruthColour, ...names.map((_, i) => estimateColour(i))],
      widensFirst: true,
      timeLabels: index >= 3,
      leads: index === 0,
    });
  }

  draw(state: State, t_s: Float64Array, span_s: Span): void {
    const truth = this.truth.update(state.data);
    this.plot.setData(t_s, [truth, ...this.curves(state, truth)], span_s);
  }

  showCursor({ playback }: State): void {
    const poses = [playback?.truth, ...this.names.map((name) => playback?.estimates[name]?.pose)];
    this.plot.showValues(poses.map((pose) => pose?.[this.axis]));
  }

  showHover(state: State, _t_s: number, row: number): void {
    const truth = this.truth.update(state.data);
    const values = [
      state.data.truth.at(this.axis, row),
      ...this.curves(state, truth).map((curve) => curve[row]),
    ];
    this.plot.showValues(
      values.map((value) =>
        isAngle(this.axis) && typeof value === 'number' ? wrapDegrees(value) : value,
      ),
    );
  }

  private curves(state: State, truth: Float64Array): (readonly (number | null)[])[] {
    return this.names.map((name, i) => {
      const rows = shownEstimate(state, name);
      return rows === undefined ? [] : (this.estimates[i]?.update(state.data, rows, truth) ?? []);
    });
  }
}

interface ImageFigure {
  column: ImageColumn;
  label: string;
  unit: string;
  per_unit: number;
  digits: number;
  least: number;
  limit?: number;
}

const kImageFigures: readonly ImageFigure[] = [
  {
    column: 'texels_per_pixel',
    label: 'Texture (median)',
    unit: 'texels/px',
    per_unit: 1,
    digits: 2,
    least: 0.5,
    limit: kTextureLimit,
  },
  { column: 'exposure_ns', label: 'Exposure', unit: 'ms', per_unit: 1e6, digits: 3, least: 0.5 },
  {
    column: 'saturated_fraction',
    label: 'Saturated pixels',
    unit: '%',
    per_unit: 0.01,
    digits: 1,
    least: 2,
  },
];

const kImageColour = 'rgb(150, 178, 220)';

export function imageStrips(actions: PlotActions): Strip[] {
  return kImageFigures.map((figure, index) => new ImageStrip(figure, index, actions));
}

class ImageStrip implements Strip {
  readonly plot: Plot;

  constructor(
    private readonly figure: ImageFigure,
    index: number,
    actions: PlotActions,
  ) {
    const { column, label, unit, digits, least, limit } = figure;
    this.plot = new Plot({
      ...actions,
      key: column,
      label,
      unit,
      digits,
      least,
      ...(limit === undefined ? {} : { limit }),
      colours: [kImageColour],
      widensFirst: true,
      timeLabels: index === kImageFigures.length - 1,
      leads: index === 0,
    });
  }

  draw({ data }: State, t_s: Float64Array, span_s: Span): void {
    const { column, per_unit } = this.figure;
    const values = Array.from(data.truth.column(column), (value) =>
      Number.isNaN(value) ? null : value / per_unit,
    );
    this.plot.setData(t_s, [values], span_s);
  }

  showCursor(state: State, row: number): void {
    this.showRow(state, row);
  }

  showHover(state: State, _t_s: number, row: number): void {
    this.showRow(state, row);
  }

  private showRow({ data }: State, row: number): void {
    const { column, per_unit } = this.figure;
    this.plot.showValues([row < 0 ? null : data.truth.at(column, row) / per_unit]);
  }
}
