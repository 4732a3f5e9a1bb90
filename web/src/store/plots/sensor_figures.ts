// The plots of the sensors' samples: as the estimators receive them, with noise and drift.

export interface SensorFigure {
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

export const kSensorFigures: readonly SensorFigure[] = [
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

const pauses = new WeakMap<readonly number[], number>();

/** A pause longer than this between values is a gap: several times the usual distance [s]. */
export function longestPause_s(t_s: readonly number[]): number {
  const known = pauses.get(t_s);
  if (known !== undefined) return known;
  const steps = t_s.slice(1).map((t, i) => t - (t_s[i] ?? t));
  steps.sort((a, b) => a - b);
  const pause_s = 5 * (steps[Math.floor(steps.length * 0.9)] ?? Infinity);
  pauses.set(t_s, pause_s);
  return pause_s;
}
