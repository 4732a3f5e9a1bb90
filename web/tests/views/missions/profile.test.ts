import { describe, expect, it } from 'vitest';
import { kUsualLimits } from '../../../src/store/missions/mission_page';
import { checkGroups } from '../../../src/views/missions/checks';
import { cursorSample, pathParts, sampleAt } from '../../../src/views/missions/map_paths';
import { summary } from '../../../src/views/missions/mission_profile';
import { kStrips, stripRange } from '../../../src/views/missions/profile_strips';
import { sampleReport } from '../../support/missions';

describe('the path on the map', () => {
  it('has parts with warnings and the beginning for estimators', () => {
    const start = {
      from_s: 0,
      to_s: 10,
      length_m: 250,
      height_agl_m: 300,
      baseline: 0.8,
      enough: true,
    };
    const warning = { kind: 'bank', text: '', from_s: 20, to_s: 20, item: 2, value: 50, limit: 45 };
    const parts = pathParts(sampleReport({ start, warnings: [warning] }));
    expect(parts.map(({ kind, points }) => [kind, points.length])).toEqual([
      ['start', 3],
      ['warned', 2],
      ['plain', 1],
    ]);
    expect(pathParts(sampleReport({ start: { ...start, enough: false } }))).toHaveLength(1);
  });

  it('finds the nearest sample of a distance and of a time', () => {
    const { samples } = sampleReport();
    expect(cursorSample(samples, -5)).toBe(0);
    expect(cursorSample(samples, 130)).toBe(1);
    expect(cursorSample(samples, 9999)).toBe(3);
    expect(cursorSample({ ...samples, distance_m: [] }, 1)).toBeNull();
    expect(sampleAt(samples, 11)).toBe(2);
    expect(sampleAt(samples, 99)).toBe(3);
  });
});

describe('the summary of a mission', () => {
  it.each([
    [45, '45 s'],
    [239.7, '4 min 0 s'],
    [239.2, '3 min 59 s'],
    [3899, '1 h 4 min'],
  ])('of %d s has the time in whole units', (duration_s, text) => {
    expect(summary(sampleReport({ duration_s }))).toBe(`0.75 km, ${text}`);
  });
});

describe('the checks', () => {
  const warning = {
    kind: 'bank',
    text: 'all of it',
    from_s: 20,
    to_s: 29.7,
    item: 2,
    value: 50.4,
    limit: 45,
  };

  it('are grouped by kind and limit', () => {
    const turn = { ...warning, from_s: null, to_s: null, item: 4, limit: 40 };
    const plan = { ...warning, kind: 'plan', value: null, limit: null };
    const groups = checkGroups([warning, { ...warning, to_s: 20, item: null }, turn, plan]);
    expect(groups.map(({ title, places }) => [title, ...places.map(({ text }) => text)])).toEqual([
      ['Bank above 45°', '50° from 20 to 30 s, item 2', '50° at 20 s'],
      ['Bank above 40°', '50° in the turn of item 4'],
      ['Not flown', 'all of it'],
    ]);
  });
});

describe('the strips of the profile', () => {
  const { samples } = sampleReport();
  const range = (label: string) => {
    const strip = kStrips.find((one) => one.label.startsWith(label));
    return strip === undefined ? [] : stripRange(strip, samples, kUsualLimits);
  };

  it('show all values, the ground, and a limit that is near', () => {
    expect(range('Path')[0]).toBeLessThan(200);
    expect(range('Path')[1]).toBeGreaterThan(500);
    expect(range('Bank')[1]).toBeGreaterThan(45);
    expect(range('Image motion')[1]).toBeLessThan(20); // the limit of 60 px is far away
    expect(range('Overlap')).toEqual([0, 1.06]);
  });
});
