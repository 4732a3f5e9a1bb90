// Plots of the sensors' samples: as the estimators receive them, with noise and drift.
import type { SensorCurve } from '../../protocol/sensor_types';
import type { CurveTable } from '../../store/sensors/sensor_curves';
import { curveTable, valueAt } from '../../store/sensors/sensor_curves';
import type { State } from '../../store/state';
import type { Span } from '../../store/time_window';
import { Plot } from './plot';
import type { PlotActions, Strip } from './plot_strips';

interface SensorFigure {
  /** Identifies the plot. */
  key: string;
  sensor: string;
  /** Names of its curves. */
  curves: readonly string[];
  names?: readonly string[];
  label: string;
  hint: string;
  unit: string;
  per_unit: number;
  digits: number;
  least: number;
}

const kAxes = ['x', 'y', 'z'] as const;

const kFigures: readonly SensorFigure[] = [
  {
    key: 'gyroscope',
    sensor: 'imu',
    curves: ['wx_rad_s', 'wy_rad_s', 'wz_rad_s'],
    names: kAxes,
    label: 'Gyro',
    hint: 'Angular rate of the body: x forward, y right, z down',
    unit: 'deg/s',
    per_unit: Math.PI / 180,
    digits: 1,
    least: 4,
  },
  {
    key: 'accelerometer',
    sensor: 'imu',
    curves: ['fx_m_s2', 'fy_m_s2', 'fz_m_s2'],
    names: kAxes,
    label: 'Accel.',
    hint: 'Specific force of the body: x forward, y right, z down; at rest z is −9.8',
    unit: 'm/s²',
    per_unit: 1,
    digits: 1,
    least: 2,
  },
  {
    key: 'magnetometer',
    sensor: 'magnetometer',
    curves: ['x_ut', 'y_ut', 'z_ut'],
    names: kAxes,
    label: 'Mag.',
    hint: 'Magnetic flux density in body axes: x forward, y right, z down',
    unit: 'µT',
    per_unit: 1,
    digits: 1,
    least: 4,
  },
  {
    key: 'gps_error',
    sensor: 'gps',
    curves: ['east_error_m', 'north_error_m', 'up_error_m'],
    names: ['E', 'N', 'U'],
    label: 'GPS err.',
    hint: 'Measured minus true place at the time of measurement: east, north, up',
    unit: 'm',
    per_unit: 1,
    digits: 1,
    least: 4,
  },
  {
    key: 'gps_velocity',
    sensor: 'gps',
    curves: ['v_east_m_s', 'v_north_m_s', 'v_down_m_s'],
    names: ['E', 'N', 'D'],
    label: 'GPS vel.',
    hint: 'Velocity over the ground: east, north, down',
    unit: 'm/s',
    per_unit: 1,
    digits: 1,
    least: 4,
  },
  {
    key: 'airspeed',
    sensor: 'airspeed',
    curves: ['indicated_airspeed_m_s'],
    label: 'Airspeed',
    hint: 'Indicated airspeed',
    unit: 'm/s',
    per_unit: 1,
    digits: 1,
    least: 2,
  },
  {
    key: 'pressure',
    sensor: 'barometer',
    curves: ['pressure_pa'],
    label: 'Pressure',
    hint: 'Static pressure of the barometer',
    unit: 'hPa',
    per_unit: 100,
    digits: 2,
    least: 1,
  },
  {
    key: 'range',
    sensor: 'range',
    curves: ['range_m'],
    label: 'Range',
    hint: 'Distance to the ground along the axis of the body that points down',
    unit: 'm',
    per_unit: 1,
    digits: 1,
    least: 4,
  },
];

const kColours = ['#ff9288', '#5fd07a', '#79b8ff'] as const;
/** Of the grid in plots.css. */
const kColumns = 3;

/** Plots of the sensors that the watched run has. */
export function shownFigures(state: State): SensorFigure[] {
  return kFigures.filter((figure) => curvesOf(state, figure).length > 0);
}

export function sensorStrips(state: State, actions: PlotActions): Strip[] {
  const figures = shownFigures(state);
  return figures.map((figure, i) => new SensorStrip(figure, i, figures.length, actions));
}

function curvesOf({ sensors, runId }: State, figure: SensorFigure): SensorCurve[] {
  if (sensors === null || sensors.run !== runId) return [];
  const found = sensors.sensors.find(({ sensor }) => sensor === figure.sensor);
  return figure.curves.flatMap((name) => found?.curves.find((curve) => curve.name === name) ?? []);
}

class SensorStrip implements Strip {
  readonly plot: Plot;
  private table: CurveTable = { t_s: new Float64Array(0), curves: [] };
  private generation = 0;
  private span_s: Span | null = null;

  constructor(
    private readonly figure: SensorFigure,
    index: number,
    count: number,
    actions: PlotActions,
  ) {
    const { key, label, hint, unit, digits, least, names, curves } = figure;
    this.plot = new Plot({
      ...actions,
      key,
      label,
      hint,
      unit,
      digits,
      least,
      ...(names === undefined ? {} : { names }),
      colours: curves.length === 1 ? ['rgb(150, 178, 220)'] : kColours,
      widensFirst: false,
      timeLabels: index >= count - kColumns,
      leads: index === 0,
    });
  }

  draw(state: State, _t_s: Float64Array, span_s: Span): void {
    const generation = state.sensors?.generation ?? 0;
    if (generation !== this.generation) {
      this.table = curveTable(curvesOf(state, this.figure), this.figure.per_unit);
    } else if (this.span_s?.[0] === span_s[0] && this.span_s[1] === span_s[1]) {
      return;
    }
    this.generation = generation;
    this.span_s = span_s;
    this.plot.setData(this.table.t_s, this.table.curves, span_s);
  }

  showCursor(state: State): void {
    // During the flight the cursor is ahead of what was read.
    const t_s = (state.playback?.t_ns ?? -1) / 1e9;
    const live = state.playback?.live === true;
    this.showAt(state, live ? Math.min(t_s, state.sensors?.newest_s ?? t_s) : t_s);
  }

  showHover(state: State, t_s: number): void {
    this.showAt(state, t_s);
  }

  private showAt(state: State, t_s: number): void {
    const values = curvesOf(state, this.figure).map((curve) => {
      const value = valueAt(curve, t_s);
      return value === null ? null : value / this.figure.per_unit;
    });
    this.plot.showValues(values);
  }
}
