import { describe, expect, it } from 'vitest';
import {
  isLayoutFile,
  readLayoutFile,
  readLayoutText,
  writeLayoutFile,
} from '../../../src/store/layouts/layout_file';
import type { LayoutNode } from '../../../src/store/layouts/layout_tree';
import type { OwnLayout } from '../../../src/store/layouts/layouts';

const kTree: LayoutNode = {
  split: 'row',
  parts: [
    { size: 300, node: { tabs: ['runs', 'log'], active: 'log' } },
    { size: 900, node: { tabs: ['scene'], active: 'scene' } },
  ],
};
const kOwn: OwnLayout[] = [
  {
    name: 'Two / three',
    tree: kTree,
    look: { view: 'orbit,215.0,35.0,900,fixed', show: 'ribbons,image', sideBySide: false },
  },
  { name: 'Höhe', tree: { tabs: ['plots'], active: 'plots' }, look: null },
];

/** A file of one layout, of which one field is another. */
function changed(edit: (layout: Record<string, unknown>) => void): string {
  const document = JSON.parse(writeLayoutFile(kOwn).text) as { layouts: Record<string, unknown>[] };
  const [layout] = document.layouts;
  if (layout !== undefined) edit(layout);
  return JSON.stringify(document);
}

const panels = (value: unknown) => changed((layout) => (layout['panels'] = value));
const look = (value: object) =>
  changed((layout) => (layout['look'] = { ...(layout['look'] as object), ...value }));
const whole = (value: object) =>
  JSON.stringify({ ...(JSON.parse(writeLayoutFile(kOwn).text) as object), ...value });

describe('a file of layouts', () => {
  it('gives back what was written', () => {
    expect(readLayoutText(writeLayoutFile(kOwn).text)).toEqual(kOwn);
  });

  it('is named by its layout, or is one of several', () => {
    expect(writeLayoutFile(kOwn.slice(0, 1)).name).toBe('Two_three.layouts.json');
    expect(writeLayoutFile(kOwn.slice(1)).name).toBe('Höhe.layouts.json');
    expect(writeLayoutFile(kOwn).name).toBe('overfly.layouts.json');
  });

  it('takes viewpoints of every mode', () => {
    for (const view of ['', 'chase,20.0,18.0,40', 'free,0.0,-30.0,1.5,-2.0,300.0']) {
      expect(readLayoutText(look({ view }))[0]?.look?.view).toBe(view);
    }
    expect(readLayoutText(look({ show: 'none' }))[0]?.look?.show).toBe('none');
  });

  const log = { tabs: ['log'], active: 'log' };
  const row = (...parts: unknown[]) => ({ split: 'row', parts });
  const wrong: [string, string, RegExp][] = [
    ['no JSON', '{"format":"overfly_layouts",', /^file: is not JSON/],
    ['another file', '{"format":"plan"}', /^format: must be "overfly_layouts"/],
    ['a list', '[]', /^format: /],
    ['nothing', 'null', /^format: /],
    ['a later version', whole({ format_version: 2, more: 1 }), /^format_version: must be 1, not 2/],
    ['a field too much', whole({ more: 1 }), /^file: has the unknown field "more"/],
    ['no layouts', whole({ layouts: [] }), /^layouts: must be a list of 1 to 50/],
    [
      'too many',
      whole({ layouts: Array(51).fill(kOwn[0]) }),
      /^layouts: must be a list of 1 to 50/,
    ],
    ['no layout', whole({ layouts: [7] }), /^layouts\[0\]: must be an object/],
    ['no name', changed((layout) => (layout['name'] = 7)), /^layouts\[0\]\.name: must be a text/],
    ['an empty name', changed((layout) => (layout['name'] = ' ')), /name: A layout needs a name/],
    [
      'a long name',
      changed((layout) => (layout['name'] = 'x'.repeat(41))),
      /name: A name has at most 40/,
    ],
    [
      'a ready-made one',
      changed((layout) => (layout['name'] = 'Fly')),
      /name: Fly is a ready-made/,
    ],
    [
      'a name twice',
      changed((layout) => (layout['name'] = 'Höhe ')),
      /^layouts\[1\]\.name: is the same/,
    ],
    ['an unknown field', changed((layout) => (layout['panel'] = 1)), /^layouts\[0\]: .* "panel"/],
    [
      'a hidden field',
      changed((layout) =>
        Object.defineProperty(layout, '__proto__', { value: 1, enumerable: true }),
      ),
      /^layouts\[0\]: .* "__proto__"/,
    ],
    ['no panels', panels(undefined), /^layouts\[0\]\.panels: must be an object/],
    ['no tabs', panels({ tabs: [], active: 'log' }), /panels\.tabs: must be a list/],
    [
      'an unknown panel',
      panels(row({ size: 1, node: { tabs: ['log', 'radar'], active: 'log' } })),
      /^layouts\[0\]\.panels\.parts\[0\]\.node\.tabs\[1\]: there is no panel "radar"/,
    ],
    [
      'an inherited name',
      panels({ tabs: ['toString'], active: 'toString' }),
      /no panel "toString"/,
    ],
    [
      'no tab in front',
      panels({ tabs: ['log'], active: 'runs' }),
      /panels\.active: must be one of/,
    ],
    [
      'a panel twice',
      panels(row({ size: 1, node: log }, { size: 1, node: log })),
      /panels: the panel "log" occurs twice/,
    ],
    [
      'a split that is none',
      panels({ split: 'grid', parts: [] }),
      /panels\.split: must be "row" or "column", not "grid"/,
    ],
    [
      'a row in a row',
      panels(row({ size: 1, node: row({ size: 1, node: log }) })),
      /parts\[0\]\.node\.split: a row must not/,
    ],
    ['a row of nothing', panels(row()), /panels\.parts: must be a list of 1 to 32/],
    [
      'a size of zero',
      panels(row({ size: 0, node: log })),
      /panels\.parts\[0\]\.size: must be a number above 0, not 0/,
    ],
    ['a long size', panels(row({ size: 'x'.repeat(999), node: log })), /not "x{39}…$/],
    [
      'a field of a part',
      panels(row({ size: 1, node: log, min: 2 })),
      /parts\[0\]: has the unknown field "min"/,
    ],
    ['rows and tabs', panels({ ...log, split: 'row' }), /panels: has the unknown field "split"/],
    ['endless depth', deep(5_000), /is more than 12 levels deep/],
    ['no mode', look({ view: 'radar,1,2,3' }), /look\.view: "radar,1,2,3" is no viewpoint/],
    ['numbers too few', look({ view: 'chase,1,2' }), /look\.view: /],
    ['no number', look({ view: 'chase,1,x,3' }), /look\.view: /],
    ['a long view', look({ view: 'x'.repeat(301) }), /look\.view: must be a text of at most 300/],
    [
      'an unknown part',
      look({ show: 'ribbons,trees' }),
      /look\.show: the 3D view has no part "trees"/,
    ],
    ['no switch', look({ side_by_side: 1 }), /look\.side_by_side: must be true or false/],
  ];
  it.each(wrong)('is refused with the field that is wrong: %s', (_what, text, message) => {
    expect(() => readLayoutText(text)).toThrow(message);
  });

  it('is refused before it is read when it is large', async () => {
    const text = () => Promise.reject(new Error('was read'));
    const file = { name: 'large.json', size: (1 << 20) + 1, text };
    await expect(readLayoutFile(file)).rejects.toThrow(/^size: 1048577 bytes: must be at most/);
  });

  it('is known from other files', async () => {
    const { text } = writeLayoutFile(kOwn);
    expect(await isLayoutFile(new File([text], 'a.JSON'))).toBe(true);
    expect(await isLayoutFile(new File([text.slice(0, 99)], 'damaged.json'))).toBe(true);
    expect(await isLayoutFile(new File(['{"columns":{}}'], 'mapping.json'))).toBe(false);
    expect(await isLayoutFile(new File([text], 'flight.csv'))).toBe(false);
  });
});

function deep(levels: number): string {
  let open = '';
  for (let i = 0; i < levels; i += 1) {
    open += `{"split":"${i % 2 === 0 ? 'row' : 'column'}","parts":[{"size":1,"node":`;
  }
  const tree = `${open}{"tabs":["log"],"active":"log"}${'}]}'.repeat(levels)}`;
  return whole({ layouts: [{ name: 'Deep', panels: 'HERE' }] }).replace('"HERE"', tree);
}
