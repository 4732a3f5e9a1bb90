// Answers of a server about calibrations.
import type { CalibrationSession, CalibrationSolution } from '../../src/protocol/calibration_types';

export function sampleSession(change: Partial<CalibrationSession> = {}): CalibrationSession {
  return {
    id: 's1',
    revision: 5,
    source: 'folder data/photos',
    uploads: false,
    board: { cols: 9, rows: 6, square_m: 0.03 },
    phase: 'taking',
    error: null,
    automatic: true,
    source_open: true,
    images: 3,
    images_total: 20,
    images_without_view: 1,
    without_view: [],
    newest: null,
    last_view: null,
    views: [
      { view: 0, name: 'a.png', left_out: false },
      { view: 1, name: 'b.png', left_out: true },
      { view: 2, name: 'c.png', left_out: false },
    ],
    most_views: 120,
    coverage: [],
    lens: { model: 'radtan', k3: false },
    solution: null,
    solve_error: null,
    ...change,
  };
}

export function sampleSolution(change: Partial<CalibrationSolution> = {}): CalibrationSolution {
  return {
    solution: 1,
    width_px: 640,
    height_px: 480,
    fx_px: 500.1,
    fy_px: 499.9,
    cx_px: 320.2,
    cy_px: 239.8,
    distortion: { model: 'radtan', coefficients: [-0.2, 0.03, 0.001, 0, 0] },
    standard_deviation: {
      fx_px: 0.1,
      fy_px: 0.1,
      cx_px: 0.2,
      cy_px: 0.2,
      coefficients: [0.001, 0.002, 0.0001, 0.0001, 0],
    },
    rms_px: 0.05,
    max_px: 0.2,
    views: [
      { view: 0, image: 'a.png', rms_px: 0.04, max_px: 0.1, tilt_deg: 20, outlier: false },
      { view: 2, image: 'c.png', rms_px: 0.06, max_px: 0.2, tilt_deg: 30, outlier: true },
    ],
    warnings: [],
    ...change,
  };
}
