import { describe, expect, it } from 'vitest';
import { plotsCsv, plotsSvg } from '../../../src/store/plots/plot_export';
import type { PlotSpec } from '../../../src/store/plots/plot_specs';

const plain = { t_scale_s: 1e-9, t_offset_s: 2, scale: 1, longest_gap_s: Infinity, wraps: false };
const spec: PlotSpec = {
  key: 'error_m',
  label: 'Error <b>',
  unit: 'm',
  digits: 3,
  least: 1,
  curves: [
    {
      name: 'A & "B"',
      short: 'A',
      hue: { kind: 'estimate', colour: 0 },
      curve: () => ({ ...plain, t: [0, 1e9 / 31, 2e9], values: [0.5, NaN, 1 / 3] }),
    },
    { name: 'none', short: '', hue: { kind: 'run', order: 0 }, curve: () => null },
  ],
};
const style = {
  background: '#fff',
  text: '#000',
  grid: '#ccc',
  curve: () => ({ colour: '#123456', width_px: 1, dash: [7, 4] }),
};

describe('plotsCsv', () => {
  it('has every value with all its digits, by the clock', () => {
    expect(plotsCsv([spec]).trimEnd().split('\n')).toEqual([
      'plot,unit,curve,t_s,value',
      'error_m,m,"A & ""B""",2,0.5',
      'error_m,m,"A & ""B""",2.032258065,',
      'error_m,m,"A & ""B""",4,0.3333333333333333',
    ]);
  });
});

describe('plotsSvg', () => {
  it('draws curves with axes and units, and breaks them', () => {
    const svg = plotsSvg([spec, spec], [2, 4], 3, style);
    expect(svg).toContain('width="960" height="260"');
    expect(svg).toContain('time [s]');
    expect(svg).toContain('stroke="#123456" stroke-width="1" stroke-dasharray="7 4"');
    const path = /<path d="([^"]*)" fill="none"/.exec(svg)?.[1] ?? '';
    expect(path).toMatch(/^M56\.0 [\d.]+M466\.0 [\d.]+$/);
  });

  it('leaves out an estimate that has diverged, and says so', () => {
    const [curve] = spec.curves;
    const diverged = {
      ...curve,
      name: 'dso',
      short: '',
      hue: { kind: 'estimate', colour: 1 } as const,
      curve: () => ({ ...plain, t: [0, 2e9], values: [0, 2e12] }),
    };
    const curves = [...spec.curves, diverged];
    const svg = plotsSvg([{ ...spec, curves, unbounded: true }], [2, 4], 1, style);
    expect(svg).toContain('dso leaves the plot');
    expect(svg).toContain('>0.8<');
    const whole = plotsSvg([{ ...spec, curves }], [2, 4], 1, style);
    expect(whole).not.toContain('leaves the plot');
    expect(whole).toContain('>2.0e12<');
  });

  it('escapes text', () => {
    const svg = plotsSvg([spec], [0, 4], 1, style);
    expect(svg).toContain('Error &#60;b&#62; [m]');
    expect(svg).toContain('A &#38; &#34;B&#34;');
    expect(svg).not.toContain('<b>');
  });

  it('is empty without plots', () => {
    expect(plotsSvg([], [0, 1], 3, style)).toContain('height="0"');
  });
});
