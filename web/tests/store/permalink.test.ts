import { describe, expect, it } from 'vitest';
import { formatPermalink, parsePermalink } from '../../src/store/permalink';

describe('permalink', () => {
  it('comes back as it was', () => {
    const link = { run: '20260102-a b&c', t_ns: 12_345_000_000 };
    expect(parsePermalink(formatPermalink(link))).toEqual(link);
  });

  it('leaves the time out while it follows live', () => {
    expect(formatPermalink({ run: 'r', t_ns: null })).toBe('#run=r');
    expect(formatPermalink({ run: null, t_ns: 3 })).toBe('');
  });

  it.each(['', '#', '#t=4x', '#run=', '#t=-1', '#t='])('reads nothing from %s', (hash) => {
    expect(parsePermalink(hash)).toEqual({ run: null, t_ns: null });
  });
});
