import { describe, expect, it } from 'vitest';
import { formatDuration, formatNumber, formatPercent, formatTime } from '../../src/store/format';

describe('formatting', () => {
  it('writes numbers with fixed digits, and a dash for none', () => {
    expect(formatNumber(3.14159, 2)).toBe('3.14');
    expect(formatNumber(-1, 1)).toBe('−1.0');
    expect(formatNumber(-0.001, 1)).toBe('0.0');
    expect(formatNumber(2381716801126.4, 2)).toBe('2.38e12');
    expect(formatNumber(-1e300, 0)).toBe('−1.00e300');
    expect(formatNumber(null, 1)).toBe('–');
    expect(formatNumber(NaN, 1)).toBe('–');
  });

  it.each([
    [0.4, '0 s'],
    [59.6, '1 min 0 s'],
    [200, '3 min 20 s'],
    [7505, '2 h 5 min'],
  ])('writes a duration of %d s as %s', (duration_s, text) => {
    expect(formatDuration(duration_s)).toBe(text);
  });

  it('writes shares as percent', () => {
    expect(formatPercent(0.9876)).toBe('98.8 %');
    expect(formatPercent(undefined)).toBe('–');
  });

  it.each([
    [0, '00:00.000'],
    [61_234_500_000, '01:01.235'],
    [59_999_600_000, '01:00.000'],
    [-5, '00:00.000'],
  ])('writes %d ns as %s', (t_ns, text) => {
    expect(formatTime(t_ns)).toBe(text);
  });
});
