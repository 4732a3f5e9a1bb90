import { describe, expect, it } from 'vitest';
import { panelsOf, readLayout, sameArrangement } from '../../../src/store/layouts/layout_tree';
import {
  kDefaultLayout,
  kReadyLayouts,
  readyLayout,
} from '../../../src/store/layouts/ready_layouts';
import { fromDock, toDock } from '../../../src/views/frame/dock_tree';

const kAreas = [
  { width_px: 1268, height_px: 706 },
  { width_px: 1904, height_px: 978 },
  { width_px: 900, height_px: 600 },
];

describe.each(kReadyLayouts.map((layout) => [layout.name, layout] as const))(
  'layout %s',
  (_, one) => {
    it.each(kAreas)('is in order in $width_px x $height_px', (area) => {
      const tree = one.arrange(area);
      expect(readLayout(JSON.parse(JSON.stringify(tree)))).toEqual(tree);
      expect(panelsOf(tree)).toContain('runs');
    });

    it.each(kAreas)('comes back from the dock of $width_px x $height_px', (area) => {
      const tree = one.arrange(area);
      const back = fromDock(toDock(tree, area));
      expect(back !== null && sameArrangement(back, tree, 0.005)).toBe(true);
    });
  },
);

describe('the ready-made layouts', () => {
  it('have the default one', () => {
    expect(readyLayout(kDefaultLayout)).toBeDefined();
  });

  it('differ', () => {
    const [area] = kAreas;
    if (area === undefined) return;
    const trees = kReadyLayouts.map(({ arrange }) => arrange(area));
    trees.forEach((a, i) =>
      trees.slice(i + 1).forEach((b) => expect(sameArrangement(a, b)).toBe(false)),
    );
  });
});

describe('two arrangements', () => {
  const two = (size: number, back: 'log' | 'runs') => ({
    split: 'row' as const,
    parts: [
      { size, node: { tabs: [back], active: back } },
      { size: 100, node: { tabs: ['scene' as const], active: 'scene' as const } },
    ],
  });

  it('are the same up to the unit of their sizes', () => {
    const doubled = two(200, 'log');
    for (const part of doubled.parts) part.size *= part.size === 200 ? 1 : 2;
    expect(sameArrangement(two(100, 'log'), doubled)).toBe(true);
  });

  it('differ by their sizes and their panels', () => {
    expect(sameArrangement(two(100, 'log'), two(150, 'log'))).toBe(false);
    expect(sameArrangement(two(100, 'log'), two(100, 'runs'))).toBe(false);
  });
});
