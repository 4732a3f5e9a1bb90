// Numeric fields of a scenario that a hunt may search, with limits that most flights have.
import type { Json, JsonObject } from '../../protocol/rest_types';
import { valueIn } from '../scenario/draft';

export interface HuntField {
  path: string;
  label: string;
  unit: string;
  from: number;
  to: number;
  /** Offered only where the document has a value at this path. */
  needs: string;
}

const kCourse = 'flight.course';
const kMission = 'flight.mission';

export const kHuntFields: readonly HuntField[] = [
  field(`${kCourse}.height_agl_m`, 'Height AGL', 'm', 60, 300, kCourse),
  field(`${kCourse}.airspeed_m_s`, 'Airspeed', 'm/s', 12, 30, kCourse),
  field(`${kCourse}.roll_rate_max_deg_s`, 'Max roll rate', 'deg/s', 20, 90, kCourse),
  field(`${kCourse}.bank_max_deg`, 'Bank limit', 'deg', 20, 55, kCourse),
  field(`${kMission}.airspeed_m_s`, 'Airspeed', 'm/s', 12, 30, kMission),
  field('camera.rate_hz', 'Frame rate', 'Hz', 8, 40, 'camera'),
  field('camera.sensor.exposure_ms', 'Exposure', 'ms', 0.5, 10, 'camera.sensor'),
  field('camera.sensor.read_noise_e', 'Read noise', 'e', 2, 60, 'camera.sensor'),
  field('camera.sensor.defocus_sigma_px', 'Defocus', 'px', 0, 2.5, 'camera.sensor'),
];

/** The fields that a document has, or may have. */
export function huntFieldsOf(document: JsonObject): HuntField[] {
  return kHuntFields.filter(({ needs }) => valueIn(document, needs) !== undefined);
}

/** Names of the entries of a list in a document: estimators, cameras. */
export function namesAt(document: JsonObject | null, path: string): string[] {
  const list = document === null ? undefined : valueIn(document, path);
  return Array.isArray(list) ? list.map(nameOf).filter((name) => name !== '') : [];
}

function nameOf(entry: Json): string {
  if (typeof entry !== 'object' || entry === null || Array.isArray(entry)) return '';
  const { name } = entry;
  return typeof name === 'string' ? name : '';
}

function field(
  path: string,
  label: string,
  unit: string,
  from: number,
  to: number,
  needs: string,
): HuntField {
  return { path, label, unit, from, to, needs };
}
