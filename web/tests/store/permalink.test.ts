import { describe, expect, it } from 'vitest';
import { formatPermalink, parsePermalink } from '../../src/store/permalink';

const kUsual = { view: '', show: '', sideBySide: true, study: null };
const alone = (id: string) => [{ id, offset_ns: 0 }];

describe('permalink', () => {
  it('comes back as it was', () => {
    const link = {
      runs: alone('20260102-a b&c'),
      main: null,
      t_ns: 12_345_000_000,
      layout: 'compare',
      view: 'orbit,10.0,20.0,300,fixed',
      show: 'aircraft,image',
      sideBySide: false,
      study: '20260102-120000-hunt-abc123',
    };
    expect(parsePermalink(formatPermalink(link))).toEqual(link);
  });

  it('has several runs with their offsets, and the main one', () => {
    const link = {
      runs: [...alone('r1'), { id: 'r2', offset_ns: -1_500_000_000 }],
      main: 'r2',
      t_ns: 0,
      layout: null,
      ...kUsual,
    };
    expect(formatPermalink(link)).toBe('#run=r1&run=r2%40-1.500&main=r2&t=0.000');
    expect(parsePermalink(formatPermalink(link))).toEqual(link);
  });

  it('leaves the time out while it follows live', () => {
    expect(
      formatPermalink({ runs: alone('r'), main: 'r', t_ns: null, layout: null, ...kUsual }),
    ).toBe('#run=r');
    expect(formatPermalink({ runs: [], main: null, t_ns: 3, layout: null, ...kUsual })).toBe('');
    expect(formatPermalink({ runs: [], main: null, t_ns: 3, layout: 'fly', ...kUsual })).toBe(
      '#layout=fly',
    );
  });

  it('has the study whose page is open, also without a run', () => {
    const link = { runs: [], main: null, t_ns: null, layout: null, ...kUsual, study: '' };
    expect(formatPermalink(link)).toBe('#study=');
    expect(parsePermalink('#study=')).toEqual(link);
    expect(parsePermalink('#layout=fly&study=a').study).toBe('a');
  });

  it('takes a run once', () => {
    expect(parsePermalink('#run=r&run=r@3').runs).toEqual(alone('r'));
  });

  it.each(['', '#', '#t=4x', '#run=', '#t=', '#main='])('reads nothing from %s', (hash) => {
    expect(parsePermalink(hash)).toEqual({
      runs: [],
      main: null,
      t_ns: null,
      layout: null,
      ...kUsual,
    });
  });
});
