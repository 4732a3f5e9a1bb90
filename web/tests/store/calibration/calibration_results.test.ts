import { describe, expect, it } from 'vitest';

import {
  calibratedSection,
  parameterRows,
  phaseText,
  viewRows,
} from '../../../src/store/calibration/calibration_results';
import { sampleSession, sampleSolution } from '../../support/calibrations';

describe('parameterRows', () => {
  it('names each parameter with its deviation, without k3 that was not estimated', () => {
    const rows = parameterRows(sampleSolution());
    expect(rows.map(({ name }) => name)).toEqual(['fx', 'fy', 'cx', 'cy', 'k1', 'k2', 'p1', 'p2']);
    expect(rows[0]).toEqual({ name: 'fx', unit: 'px', value: 500.1, deviation: 0.1, truth: null });
  });

  it('compares with the truth where the models are comparable', () => {
    const pinhole = { fx_px: 500, fy_px: 500, cx_px: 320, cy_px: 240 };
    const none = { ...pinhole, distortion: { model: 'none', coefficients: [] } };
    const rows = parameterRows(sampleSolution({ truth: none }));
    expect(rows[0]?.truth).toBe(500);
    expect(rows[4]?.truth).toBe(0);
    const fisheye = { ...pinhole, distortion: { model: 'equidistant', coefficients: [0.1] } };
    expect(parameterRows(sampleSolution({ truth: fisheye }))[4]?.truth).toBeNull();
  });
});

describe('viewRows', () => {
  it('lists every view, with the figures of those in the estimate', () => {
    const page = { session: sampleSession(), solution: sampleSolution(), leftOut: null };
    const rows = viewRows(page);
    expect(
      rows.map(({ view, rms_px, leftOut, outlier }) => [view, rms_px, leftOut, outlier]),
    ).toEqual([
      [0, 0.04, false, false],
      [1, null, true, false],
      [2, 0.06, false, true],
    ]);
    expect(viewRows({ ...page, solution: null }).every(({ rms_px }) => rms_px === null)).toBe(true);
    const wanted = viewRows({ ...page, leftOut: new Set([2]) });
    expect(wanted.map(({ leftOut }) => leftOut)).toEqual([false, false, true]);
    expect(viewRows({ ...page, session: null })).toEqual([]);
  });
});

describe('phaseText', () => {
  it('says what happens', () => {
    expect(phaseText(sampleSession())).toBe('3 of 20 images searched, 3 views');
    const waiting = { uploads: true, images: 0, images_total: null, views: [] };
    expect(phaseText(sampleSession(waiting))).toBe('Waiting for images');
    expect(phaseText(sampleSession({ phase: 'solving' }))).toContain('Estimating');
    expect(phaseText(sampleSession({ phase: 'waiting', source_open: false }))).toContain(
      'no more images',
    );
  });
});

describe('calibratedSection', () => {
  it('replaces what the file determines and keeps the rest', () => {
    const camera = { width_px: 640, fov_deg: 80, distortion: {}, rate_hz: 31, name: 'down' };
    expect(calibratedSection({ camera }, '/data/c.json')).toEqual({
      section: 'camera',
      value: { calibration: '/data/c.json', rate_hz: 31, name: 'down' },
    });
    const several = { cameras: [camera, { name: 'ahead', fx_px: 3 }] };
    expect(calibratedSection(several, 'f')).toEqual({
      section: 'cameras',
      value: [
        { calibration: 'f', rate_hz: 31, name: 'down' },
        { name: 'ahead', fx_px: 3 },
      ],
    });
    expect(calibratedSection({}, 'f').value).toEqual({ calibration: 'f' });
  });
});
