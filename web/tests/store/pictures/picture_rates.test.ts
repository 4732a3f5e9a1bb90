import { describe, expect, it } from 'vitest';
import { kNoRate, PictureMeter, rateBadge } from '../../../src/store/pictures/picture_rates';

describe('PictureMeter', () => {
  it('measures rate and bytes of the last two seconds', () => {
    const meter = new PictureMeter();
    for (let k = 0; k < 100; k += 1) meter.count('camera', 5000, 'vp8', 40 * k);
    const rate = meter.rate('camera', 40 * 99);
    expect(rate?.hz).toBeCloseTo(25, 9);
    expect(rate?.bytes_per_s).toBeCloseTo(125000, 6);
    expect(rate?.encoding).toBe('vp8');
    expect(meter.rate('camera', 40 * 99 + 2500)).toBeNull();
    expect(meter.rate('scene', 0)).toBeNull();
  });
});

describe('rateBadge', () => {
  const measured = { hz: 14.96, bytes_per_s: 250000, encoding: 'jpeg' } as const;

  it('tells rate, amount and coding', () => {
    expect(rateBadge(measured, undefined, 0)).toEqual({
      text: '15 Hz',
      hint: 'Measured: 15 Hz, 2.0 Mbit/s as JPEG',
      reduced: false,
    });
    expect(rateBadge(null, undefined, 2)).toBe(kNoRate);
  });

  it('tells by how much pictures are reduced for a slow connection', () => {
    const badge = rateBadge(measured, undefined, 2);
    expect(badge.text).toBe('15 Hz ▾2');
    expect(badge.reduced).toBe(true);
    expect(badge.hint).toContain('step 2 of 4');
  });

  it('tells first that a flight has priority', () => {
    expect(rateBadge(measured, { now_hz: 5, asked_hz: 31 }, 1).text).toBe('5/31 Hz');
  });
});
