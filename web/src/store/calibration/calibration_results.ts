// What the calibration page says of an estimate: its parameters, views and warnings; and a saved
// calibration in a scenario.
import type {
  CalibrationSession,
  CalibrationSolution,
  Intrinsics,
} from '../../protocol/calibration_types';
import type { Json, JsonObject } from '../../protocol/rest_types';
import type { CalibrationPage } from './calibration_page';

export interface ParameterRow {
  name: string;
  unit: string;
  value: number;
  deviation: number;
  /** Of a virtual camera. */
  truth: number | null;
}

const kCoefficients: Readonly<Record<string, readonly string[]>> = {
  radtan: ['k1', 'k2', 'p1', 'p2', 'k3'],
  equidistant: ['k1', 'k2', 'k3', 'k4'],
};
const kPinhole = ['fx', 'fy', 'cx', 'cy'] as const;

export function parameterRows(solution: CalibrationSolution): ParameterRow[] {
  const { truth, standard_deviation, distortion } = solution;
  const rows: ParameterRow[] = kPinhole.map((name) => ({
    name,
    unit: 'px',
    value: solution[`${name}_px`],
    deviation: standard_deviation[`${name}_px`],
    truth: truth === undefined ? null : truth[`${name}_px`],
  }));
  const names = kCoefficients[distortion.model] ?? [];
  distortion.coefficients.forEach((value, i) => {
    const deviation = standard_deviation.coefficients[i] ?? 0;
    // k3 of radtan that was not estimated.
    if (value === 0 && deviation === 0) return;
    rows.push({
      name: names[i] ?? `k${i + 1}`,
      unit: '',
      value,
      deviation,
      truth: trueCoefficient(truth, distortion.model, i),
    });
  });
  return rows;
}

/** Comparable only between equal models; no distortion is one of zeros. */
function trueCoefficient(truth: Intrinsics | undefined, model: string, i: number): number | null {
  if (truth === undefined) return null;
  if (truth.distortion.model === 'none' && model === 'radtan') return 0;
  return truth.distortion.model === model ? (truth.distortion.coefficients[i] ?? null) : null;
}

export interface ViewRow {
  view: number;
  name: string;
  rms_px: number | null;
  max_px: number | null;
  tilt_deg: number | null;
  leftOut: boolean;
  outlier: boolean;
}

/** Views that a session leaves out of its estimate. */
export function leftOutBy({ views }: CalibrationSession): Set<number> {
  return new Set(views.filter(({ left_out }) => left_out).map(({ view }) => view));
}

/** All views of the session, with the residuals of those in the estimate. */
export function viewRows(
  page: Pick<CalibrationPage, 'session' | 'solution' | 'leftOut'>,
): ViewRow[] {
  const { session, solution } = page;
  if (session === null) return [];
  const leftOut = page.leftOut ?? leftOutBy(session);
  const solved = new Map((solution?.views ?? []).map((view) => [view.view, view]));
  return session.views.map(({ view, name }) => {
    const found = solved.get(view);
    return {
      view,
      name,
      rms_px: found?.rms_px ?? null,
      max_px: found?.max_px ?? null,
      tilt_deg: found?.tilt_deg ?? null,
      leftOut: leftOut.has(view),
      outlier: found?.outlier ?? false,
    };
  });
}

/** What a session is doing, in one line. */
export function phaseText(session: CalibrationSession): string {
  const { phase, images, images_total, views, uploads, source_open } = session;
  const seen = images_total === null ? `${images} images` : `${images} of ${images_total} images`;
  const found = `${views.length} ${views.length === 1 ? 'view' : 'views'}`;
  switch (phase) {
    case 'opening':
      return 'Opening the source';
    case 'taking':
      return uploads && images === 0 ? 'Waiting for images' : `${seen} searched, ${found}`;
    case 'solving':
      return `Estimating the camera from ${found}`;
    case 'failed':
      return `${found}; the source has failed`;
    case 'waiting':
      return `${seen} searched, ${found}${source_open ? '' : '; no more images'}`;
  }
}

const kOwnFields = [
  'width_px',
  'height_px',
  'fov_deg',
  'fov_axis',
  'fx_px',
  'fy_px',
  'cx_px',
  'cy_px',
  'distortion',
  'calibration',
];

/**
 * The section of a scenario in which its first camera uses a calibration file: without the fields
 * that the file determines.
 */
export function calibratedSection(
  document: JsonObject,
  file: string,
): { section: string; value: Json } {
  const several = document['cameras'];
  if (Array.isArray(several) && several.length > 0) {
    const [first, ...others] = several as [Json, ...Json[]];
    return { section: 'cameras', value: [withFile(first, file), ...others] };
  }
  return { section: 'camera', value: withFile(document['camera'] ?? {}, file) };
}

function withFile(camera: Json, file: string): JsonObject {
  const fields =
    typeof camera === 'object' && camera !== null && !Array.isArray(camera) ? camera : {};
  const kept = Object.entries(fields).filter(([name]) => !kOwnFields.includes(name));
  return { calibration: file, ...Object.fromEntries(kept) };
}

export function sameViews(some: ReadonlySet<number>, others: ReadonlySet<number>): boolean {
  return some.size === others.size && [...some].every((view) => others.has(view));
}
