import { describe, expect, it } from 'vitest';
import {
  ambiguityOf,
  camerasOf,
  initialForm,
  lensOf,
  requestOf,
} from '../../../src/store/calibration/calibration_form';

const form = (change = {}) => {
  const made = { ...initialForm(), ...change };
  made.names.scenario = 'course';
  return made;
};
const error = (change = {}) => {
  const request = requestOf(form(change));
  return 'error' in request ? request.error : null;
};

describe('requestOf', () => {
  it('asks for a virtual board in metres', () => {
    expect(requestOf(form({ camera: 'down' }))).toEqual({
      value: {
        source: { kind: 'scenario', name: 'course', camera: 'down', views: 20 },
        board: { cols: 9, rows: 6, square_m: 0.03 },
        accept_symmetric: false,
        model: 'radtan',
        k3: false,
      },
    });
  });

  it('asks for markers and a topic only where they matter', () => {
    const names = { ...initialForm().names, recording: 'data/a.bag' };
    const charuco = { board: '5x5', cols: '7', rows: '5', marker_mm: '20' };
    const request = requestOf({ ...form(charuco), kind: 'recording', names, topic: ' /cam ' });
    expect(request).toMatchObject({
      value: {
        source: { kind: 'recording', name: 'data/a.bag', topic: '/cam' },
        board: { cols: 7, rows: 5, square_m: 0.03, markers: '5x5', marker_m: 0.02 },
      },
    });
    const plain = requestOf({ ...form(charuco), kind: 'recording', names });
    expect(plain).toMatchObject({ value: { source: { kind: 'recording', name: 'data/a.bag' } } });
    expect(requestOf(form({ kind: 'upload' }))).toMatchObject({
      value: { source: { kind: 'upload' } },
    });
  });

  it('names what is wrong', () => {
    expect(error({ kind: 'folder' })).toBe('Choose a folder.');
    expect(error({ views: '3' })).toContain('[4, 200]');
    expect(error({ cols: '2' })).toContain('Columns');
    expect(error({ rows: 'six' })).toContain('Rows');
    expect(error({ square_mm: '0' })).toContain('Square');
    expect(error({ board: '4x4', marker_mm: '29' })).toContain('Marker');
  });
});

describe('ambiguityOf', () => {
  it('refuses boards that look the same after half a turn, with the reason', () => {
    expect(ambiguityOf(form({ cols: '7', rows: '7' }))).toContain('both numbers are odd');
    expect(ambiguityOf(form({ cols: '8', rows: '6' }))).toContain('both numbers are even');
    expect(ambiguityOf(form({ cols: '8', rows: '6' }))).toContain('8 x 7');
    expect(ambiguityOf(form())).toBeNull();
    expect(ambiguityOf(form({ cols: '7', rows: '5', board: '4x4' }))).toBeNull();
    expect(error({ cols: '7', rows: '7' })).toContain('half a turn');
    expect(error({ cols: '7', rows: '7', acceptSymmetric: true })).toBeNull();
  });
});

describe('lensOf', () => {
  it('has k3 only with radtan', () => {
    expect(lensOf(form({ model: 'radtan', k3: true }))).toEqual({ model: 'radtan', k3: true });
    expect(lensOf(form({ model: 'equidistant', k3: true })).k3).toBe(false);
  });
});

describe('camerasOf', () => {
  it('names the cameras of a scenario', () => {
    expect(camerasOf({ camera: { name: 'a' } })).toEqual(['a']);
    expect(camerasOf({ cameras: [{ name: 'a' }, { name: 'b' }] })).toEqual(['a', 'b']);
    expect(camerasOf({})).toEqual(['camera0']);
  });
});
