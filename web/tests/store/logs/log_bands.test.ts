import { describe, expect, it } from 'vitest';
import {
  bandHue,
  eventsOf,
  marksOf,
  marksWithin,
  modeBands,
} from '../../../src/store/logs/log_bands';

const mode = (t_s: number | null, text: string) => ({ t_s, kind: 'mode', text });

describe('the bands of a log', () => {
  it('last until the next mode, the last one to the end', () => {
    const events = [mode(10, 'mode 0 (MANUAL)'), mode(30, 'mode 10 (AUTO)'), mode(30.5, 'mode 4')];
    expect(modeBands(events, 90)).toEqual([
      { begin_s: 10, end_s: 30, text: 'MANUAL' },
      { begin_s: 30, end_s: 30.5, text: 'AUTO' },
      { begin_s: 30.5, end_s: 90, text: 'mode 4' },
    ]);
  });

  it('join repeated modes, and leave out those without a time', () => {
    const events = [mode(5, 'mode 1'), mode(null, 'mode 2'), mode(7, 'mode 1')];
    expect(modeBands(events, 9)).toEqual([{ begin_s: 5, end_s: 9, text: 'mode 1' }]);
    expect(modeBands([], 9)).toEqual([]);
  });

  it('are those of the vehicle and the run of its clock that are shown', () => {
    const events = [
      { ...mode(10, 'mode 1'), vehicle: '1.1', run: 0 },
      { ...mode(10, 'mode 2'), vehicle: '1.1', run: 1 },
      { ...mode(10, 'mode 3'), vehicle: '2.1', run: 1 },
      { ...mode(10, 'mode 4'), run: 1 },
    ];
    expect(eventsOf(events, { vehicle: '1.1', run: 1 })).toEqual([events[1]]);
    expect(eventsOf(events, { vehicle: '', run: 1 })).toEqual([events[3]]);
  });

  it('leave marks outside of the time axis out', () => {
    const marks = [1, 2, 3, 4].map((t_s) => ({ t_s, kind: 'arming', text: 'armed' }));
    expect(marksWithin(marks, [2, 3])).toEqual(marks.slice(1, 3));
  });

  it('have the same colour for the same name', () => {
    expect(bandHue('AUTO')).toBe(bandHue('AUTO'));
    expect(bandHue('AUTO')).not.toBe(bandHue('RTL'));
  });

  it('are joined by marks of the other events', () => {
    const events = [
      mode(1, 'mode 1'),
      { t_s: 2, kind: 'arming', text: 'armed' },
      { t_s: 3, kind: 'camera', text: 'image 7' },
      { t_s: null, kind: 'text', text: 'hello' },
    ];
    expect(marksOf(events)).toEqual([{ t_s: 2, kind: 'arming', text: 'armed' }]);
  });
});
