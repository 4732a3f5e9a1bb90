import { describe, expect, it } from 'vitest';

import { layoutText } from '../../../src/store/layouts/layout_text';

import type { LayoutNode } from '../../../src/store/layouts/layout_tree';
import { usualChoices } from '../../../src/store/link/link_choices';
import type { LinkedRun, Permalink } from '../../../src/store/link/permalink';
import { formatPermalink, parsePermalink } from '../../../src/store/link/permalink';

const kUsual: Permalink = {
  runs: [],
  main: null,
  t_ns: null,
  layout: null,
  panels: null,
  view: '',
  show: '',
  sideBySide: true,
  choices: usualChoices(),
  study: null,
};
const kPanels: LayoutNode = {
  split: 'row',
  parts: [
    { size: 4000, node: { tabs: ['runs', 'log'], active: 'log' } },
    { size: 6000, node: { tabs: ['scene'], active: 'scene' } },
  ],
};

function alone(id: string, more: Partial<LinkedRun> = {}): LinkedRun[] {
  const none = { hidden: new Set<string>(), camera: null, colours: new Map<string, string>() };
  return [{ id, offset_ns: 0, ...none, ...more }];
}

function read(hash: string): Permalink {
  const { problems, ...link } = parsePermalink(hash);
  expect(problems).toEqual([]);
  return link;
}

describe('permalink', () => {
  it('comes back as it was', () => {
    const link: Permalink = {
      runs: [
        ...alone('20260102-a b&c', { hidden: new Set(['', 'dso, fast']), camera: 'left' }),
        ...alone('r2', {
          hidden: new Set(['a/b']),
          offset_ns: 2e9,
          colours: new Map([
            ['', '3'],
            ['a,b/c', 'ff8800'],
          ]),
        }),
      ],
      main: null,
      t_ns: 12_345_000_000,
      layout: 'compare',
      panels: kPanels,
      view: 'orbit,10.0,20.0,300,fixed',
      show: 'aircraft,image',
      sideBySide: false,
      choices: {
        alignment: 'sim3',
        compared: 'se3',
        plotGroup: 'errors',
        window_s: [-1.5, 20.25],
        clock: { range: { begin_ns: 1_500_000_000, end_ns: 9e9 }, speed: -0.5, loop: true },
        debugOf: 'feature',
        imageErrorOf: 'direct',
        zooms: new Map([
          ['camera', { scale: 4, x: 0.25, y: 0.75 }],
          ['debug/a,b', { scale: 1.5, x: 0.5, y: 0.5 }],
        ]),
      },
      study: '20260102-120000-hunt-abc123',
    };
    expect(read(formatPermalink(link))).toEqual(link);
  });

  it('has several runs with their offsets, and the main one', () => {
    const runs = [...alone('r1'), ...alone('r2', { offset_ns: -1_500_000_000 })];
    const link = { ...kUsual, runs, main: 'r2', t_ns: 0 };
    expect(formatPermalink(link)).toBe('#run=r1&run=r2%40-1.5&main=r2&t=0');
    expect(read(formatPermalink(link))).toEqual(link);
  });

  it('leaves out an offset that the server does not take', () => {
    const { runs, problems } = parsePermalink('#run=r1@86400&run=r2@-86400.1');
    expect(runs.map(({ id, offset_ns }) => [id, offset_ns])).toEqual([
      ['r1', 86_400e9],
      ['r2', 0],
    ]);
    expect(problems).toHaveLength(1);
  });

  it('has times to the nanosecond: a frame is not one before', () => {
    const choices = usualChoices();
    choices.clock = { range: { begin_ns: 32_258_065, end_ns: 64_516_129 }, speed: 1, loop: false };
    const runs = [...alone('r1'), ...alone('r2', { offset_ns: 1 })];
    const link = { ...kUsual, runs, t_ns: 86_399_967_741_935, choices };
    expect(formatPermalink(link)).toBe(
      '#run=r1&run=r2%400.000000001&range=0.032258065%2C0.064516129&t=86399.967741935',
    );
    expect(read(formatPermalink(link))).toEqual(link);
  });

  it('leaves the time out while it follows live, and the choices where they are usual', () => {
    const link = { ...kUsual, runs: alone('r'), main: 'r' };
    expect(formatPermalink(link)).toBe('#run=r');
    expect(formatPermalink({ ...kUsual, t_ns: 3 })).toBe('');
    expect(formatPermalink({ ...kUsual, t_ns: 3, layout: 'fly' })).toBe('#layout=fly');
  });

  it('names runs by letters where they are hidden in part', () => {
    const runs = [...alone('r1'), ...alone('r2', { hidden: new Set(['', 'feature']) })];
    expect(formatPermalink({ ...kUsual, runs })).toBe('#run=r1&run=r2&hide=B&hide=B%2Ffeature');
  });

  it('has the study whose page is open, also without a run', () => {
    expect(formatPermalink({ ...kUsual, study: '' })).toBe('#study=');
    expect(read('#study=')).toEqual({ ...kUsual, study: '' });
    expect(parsePermalink('#layout=fly&study=a').study).toBe('a');
  });

  it('takes a run once', () => {
    expect(parsePermalink('#run=r&run=r@3').runs).toEqual(alone('r'));
  });

  it.each(['', '#', '#run=', '#t=', '#main=', '#unknown=3'])('reads nothing from %s', (hash) => {
    expect(read(hash)).toEqual(kUsual);
  });

  it.each([
    ['t', '4x'],
    ['align', 'Sim(3)'],
    ['plots', '<script>'],
    ['plots', 'zzz'],
    ['compare', 'a b'],
    ['window', '3,1'],
    ['window', '1'],
    ['range', '1,Infinity'],
    ['range', '1,99999999999999999999'],
    ['window', '50000000000000000,50000000000000008'],
    ['window', '1,1.0001'],
    ['t', '1e300'],
    ['t', '99999999999'],
    ['range', '1,2,3'],
    ['speed', '1000'],
    ['speed', 'NaN'],
    ['loop', 'yes'],
    ['debug', ''],
    ['error', 'n'.repeat(201)],
    ['zoom', '0.5,0.5,0.5,camera'],
    ['zoom', '2,0.5,1.5,camera'],
    ['zoom', '2,0.5,NaN,camera'],
    ['zoom', '2,0.5,0.5'],
    ['hide', 'B'],
    ['hide', 'Z/feature'],
    ['hide', 'a'],
    ['camera', 'A'],
    ['camera', '3,A/left'],
    ['hide', '3,A'],
    ['colour', 'A/feature'],
    ['colour', '7,A/feature'],
    ['colour', 'FF0000,A'],
    ['colour', 'url(x),A'],
    ['camera', `A/${'n'.repeat(201)}`],
    ['panels', 'e30'],
  ])('leaves out %s=%s, says so, and reads the rest', (name, value) => {
    const fields = new URLSearchParams({ run: 'r', speed: '2', [name]: value, view: 'top' });
    const { problems, runs, view } = parsePermalink(`#${fields.toString()}`);
    expect(problems).toHaveLength(1);
    expect(problems[0]).toContain(name);
    expect(problems[0]?.length).toBeLessThan(120);
    expect(runs).toEqual(alone('r'));
    expect(view).toBe('top');
  });

  it('says that the offset of a run cannot be read, and shows the run', () => {
    const { runs, problems } = parsePermalink(`#run=r@${'9'.repeat(305)}&run=s@1.2.3`);
    expect(runs).toEqual([...alone('r'), ...alone('s')]);
    expect(problems).toHaveLength(2);
    expect(problems[0]?.length).toBeLessThan(60);
  });

  it('writes no more than it reads', () => {
    const names = (count: number) => Array.from({ length: count }, (_, i) => `n${i}`);
    const hidden = new Set(names(500));
    const colours = new Map(names(500).map((name) => [name, '3']));
    const runs = Array.from({ length: 16 }, (_, i) => alone(`r${i}`, { hidden, colours })).flat();
    const zooms = new Map(names(100).map((group) => [group, { scale: 2, x: 0.5, y: 0.5 }]));
    const choices = { ...usualChoices(), zooms };
    const { problems } = parsePermalink(formatPermalink({ ...kUsual, runs, choices }));
    expect(problems).toEqual([]);
  });

  it('takes no more than a viewer can have', () => {
    const many = (count: number, part: (i: number) => string) =>
      Array.from({ length: count }, (_, i) => part(i)).join('&');
    const runs = parsePermalink(`#${many(40, (i) => `run=r${i}`)}`);
    expect(runs.runs).toHaveLength(16);
    expect(runs.problems).toEqual(['more than 16 runs']);
    const hidden = parsePermalink(`#run=r&${many(5000, (i) => `hide=A/n${i}`)}`);
    expect(hidden.runs[0]?.hidden.size).toBe(1000);
    expect(hidden.problems).toEqual(['hide']);
    const zooms = parsePermalink(`#${many(100, (i) => `zoom=2,0.5,0.5,g${i}`)}`);
    expect(zooms.choices.zooms.size).toBe(40);
    expect(zooms.problems).toEqual(['zoom']);
  });

  it('has an arrangement of panels next to the name of a layout', () => {
    const hash = formatPermalink({ ...kUsual, layout: 'camera', panels: kPanels });
    expect(hash).toBe(`#layout=camera&panels=${layoutText(kPanels)}`);
    expect(read(hash).panels).toEqual(kPanels);
  });
});
