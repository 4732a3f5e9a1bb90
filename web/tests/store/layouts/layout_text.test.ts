import { describe, expect, it } from 'vitest';
import { layoutOfText, layoutText } from '../../../src/store/layouts/layout_text';
import type { LayoutNode } from '../../../src/store/layouts/layout_tree';
import { LayoutError, sameArrangement, sameFront } from '../../../src/store/layouts/layout_tree';
import { kPanelNames } from '../../../src/store/layouts/panel_names';
import { kReadyLayouts } from '../../../src/store/layouts/ready_layouts';

const area = { width_px: 1823, height_px: 951 };

function encoded(value: unknown): string {
  return btoa(typeof value === 'string' ? value : JSON.stringify(value)).replace(/=+$/, '');
}

describe('an arrangement as text', () => {
  it.each(kReadyLayouts.map((layout) => [layout.name, layout.arrange(area)] as const))(
    'comes back as it was: %s',
    (_name, tree) => {
      const text = layoutText(tree);
      expect(text).toMatch(/^[\w-]{20,500}$/);
      const back = layoutOfText(text);
      expect(sameArrangement(back, tree, 0.002)).toBe(true);
      expect(sameFront(back, tree)).toBe(true);
      expect(layoutText(back)).toBe(text);
    },
  );

  it('keeps the tab in front, and a single place', () => {
    const tree: LayoutNode = { tabs: ['scene', 'plots', 'camera'], active: 'plots' };
    expect(layoutOfText(layoutText(tree))).toEqual(tree);
  });

  it('fits for all panels in places of their own', () => {
    const parts = kPanelNames.map((name) => ({ size: 1, node: { tabs: [name], active: name } }));
    const tree: LayoutNode = { split: 'row', parts };
    expect(layoutOfText(layoutText(tree))).toMatchObject({ split: 'row' });
  });

  it.each([
    ['no base64', '%%%', 'not an arrangement'],
    ['no JSON', encoded('{"row":'), 'not an arrangement'],
    ['a number', encoded(7), 'must be an object'],
    ['nothing', encoded('null'), 'must be an object'],
    ['an unknown panel', encoded('"radar"'), 'no panel "radar"'],
    ['an empty place', encoded('""'), 'no panel ""'],
    ['a panel twice', encoded({ row: [1, 'scene', 1, 'scene'] }), 'occurs twice'],
    ['two directions', encoded({ row: [1, 'scene'], column: [1, 'log'] }), 'a row or a column'],
    ['no direction', encoded({}), 'a row or a column'],
    ['another field', encoded({ row: [1, 'scene'], x: 1 }), 'unknown field "x"'],
    ['no list', encoded({ row: 'scene' }), 'sizes and parts'],
    ['a size without a part', encoded({ row: [1, 'scene', 2] }), 'sizes and parts'],
    ['an empty row', encoded({ row: [] }), '1 to 32 parts'],
    ['a negative size', encoded({ row: [-1, 'scene'] }), 'above 0'],
    ['a size as text', encoded({ row: ['1', 'scene'] }), 'above 0'],
    ['a row in a row', encoded({ row: [1, { row: [1, 'scene'] }] }), 'directly in a row'],
    ['a prototype', encoded('{"__proto__":[1,"scene"]}'), 'unknown field "__proto__"'],
    ['a text without end', 'A'.repeat(5000), 'at most 2000'],
  ])('refuses %s', (_name, text, problem) => {
    expect(() => layoutOfText(text)).toThrow(LayoutError);
    expect(() => layoutOfText(text)).toThrow(problem);
  });

  it('refuses what is nested without end', () => {
    const deep = Array.from({ length: 30 }).reduce<unknown>(
      (inner, _, i) => ({ [i % 2 === 0 ? 'row' : 'column']: [1, inner] }),
      'scene',
    );
    expect(() => layoutOfText(encoded(deep))).toThrow('12 levels');
  });
});
