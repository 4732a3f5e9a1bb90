// Names and units for people, made of the names of a scenario's fields, which end with their unit.

const kUnits: readonly (readonly [suffix: string, unit: string])[] = [
  ['_rad_s2_sqrt_hz', 'rad/s²/√Hz'],
  ['_rad_s_sqrt_hz', 'rad/s/√Hz'],
  ['_m_s3_sqrt_hz', 'm/s³/√Hz'],
  ['_m_s2_sqrt_hz', 'm/s²/√Hz'],
  ['_psd_m2_s5', 'm²/s⁵'],
  ['_psd_rad2_s3', 'rad²/s³'],
  ['_dn_per_e', 'DN/e'],
  ['_deg_s', 'deg/s'],
  ['_rms_mrad', 'mrad'],
  ['_rms_mm', 'mm'],
  ['_m_s', 'm/s'],
  ['_deg', 'deg'],
  ['_rpm', 'rpm'],
  ['_utc_s', 's'],
  ['_per_s', '1/s'],
  ['_pa', 'Pa'],
  ['_ut', 'µT'],
  ['_px', 'px'],
  ['_hz', 'Hz'],
  ['_ms', 'ms'],
  ['_km', 'km'],
  ['_mb', 'MB'],
  ['_dn', 'DN'],
  ['_m', 'm'],
  ['_s', 's'],
  ['_e', 'e'],
  ['_k', 'K'],
];

/** Words that are not written as they stand in a name. */
const kWords: Record<string, string> = {
  agl: 'AGL',
  fov: 'field of view',
  gps: 'GPS',
  imu: 'IMU',
  fx: 'focal length x',
  fy: 'focal length y',
  cx: 'principal point x',
  cy: 'principal point y',
  prnu: 'PRNU',
  dsnu: 'DSNU',
  adc: 'ADC',
  rms: 'RMS',
  cpus: 'CPUs',
  lcm: 'LCM',
  ros: 'ROS',
  ros1: 'ROS',
  crs: 'CRS',
  url: 'URL',
  uri: 'URI',
  utc: 'UTC',
  lat: 'latitude',
  lon: 'longitude',
  alt: 'altitude',
  ini: 'first',
  fast: 'FAST',
  max: 'largest',
  min: 'smallest',
  tf: 'TF',
};

/** Whole names whose parts do not tell enough. */
const kNames: Record<string, string> = {
  distortion: 'Lens',
  detail: 'Synthetic detail',
  start_s: 'Start',
  epoch_utc_s: 'Time of the start (Unix)',
  fov_axis: 'Field of view along',
  roll_rate_max_deg_s: 'Largest roll rate',
  bank_max_deg: 'Bank limit',
  rate_hz: 'Rate',
  q_xyzw: 'Quaternion x y z w',
  p_body_m: 'Position in the body',
  throttle_hz: 'Largest rate',
  low_texture: 'Low texture',
  color: 'Colour',
  builtin: 'Built-in landscape',
  plan: 'Plan',
};

export function unitOf(name: string): string {
  return kUnits.find(([suffix]) => name.endsWith(suffix))?.[1] ?? '';
}

export function labelOf(name: string): string {
  const whole = kNames[name];
  if (whole !== undefined) return whole;
  const [suffix = ''] = kUnits.find(([end]) => name.endsWith(end)) ?? [];
  const words = name
    .slice(0, name.length - suffix.length)
    .split('_')
    .map((word) => kWords[word] ?? word)
    .join(' ');
  return words.charAt(0).toUpperCase() + words.slice(1);
}
