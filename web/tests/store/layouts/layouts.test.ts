import { describe, expect, it } from 'vitest';
import type { LayoutNode } from '../../../src/store/layouts/layout_tree';
import type { Arranger, LayoutLook, LookKeeper } from '../../../src/store/layouts/layouts';
import { Layouts } from '../../../src/store/layouts/layouts';
import { Notices } from '../../../src/store/notices';
import { Store } from '../../../src/store/state';

const kArea = { width_px: 1280, height_px: 706 };
const kTree: LayoutNode = {
  split: 'row',
  parts: [
    { size: 300, node: { tabs: ['runs', 'log'], active: 'log' } },
    { size: 900, node: { tabs: ['scene'], active: 'scene' } },
  ],
};

class FakeStorage {
  constructor(public text: string | null = null) {}
  getItem(): string | null {
    return this.text;
  }
  setItem(_key: string, text: string): void {
    this.text = text;
  }
}

class FakeKeeper implements LookKeeper {
  shown: LayoutLook = { view: '', show: '', sideBySide: true };
  look(): LayoutLook {
    return this.shown;
  }
  apply(look: LayoutLook): void {
    this.shown = look;
  }
}

function open(storage: FakeStorage) {
  const store = new Store();
  const keeper = new FakeKeeper();
  const layouts = new Layouts(store, new Notices(store, () => undefined), storage, keeper);
  let arranged = 0;
  const arranger: Arranger = {
    arrange: () => (arranged += 1),
    show: () => undefined,
    hide: () => undefined,
    panels: () => [],
    tree: () => kTree,
    restore: () => undefined,
  };
  layouts.use(arranger);
  const said = () => store.state.notices.map(({ text }) => text);
  return { layouts, said, arranged: () => arranged, keeper };
}

describe('the layouts', () => {
  it('begin with the default one', () => {
    const { layouts, said } = open(new FakeStorage());
    expect(layouts.current).toBe('fly');
    expect(layouts.shared).toEqual({ name: 'fly', tree: null });
    expect(said()).toEqual([]);
  });

  it('keep what the viewer rearranged, and undo it', () => {
    const storage = new FakeStorage();
    const first = open(storage);
    first.layouts.choose('compare');
    first.layouts.onRearranged(kTree);
    const { layouts, arranged } = open(storage);
    expect(layouts.current).toBe('compare');
    expect(layouts.shared).toEqual({ name: 'compare', tree: kTree });
    expect(layouts.arrangement(kArea)).toEqual(kTree);
    layouts.reset();
    expect(arranged()).toBe(1);
    expect(layouts.shared).toEqual({ name: 'compare', tree: null });
    expect(layouts.arrangement(kArea)).not.toEqual(kTree);
  });

  it('keep own ones by name', () => {
    const storage = new FakeStorage();
    expect(open(storage).layouts.saveAs('  Mine ')).toBe(null);
    const { layouts } = open(storage);
    expect(layouts.ownNames).toEqual(['Mine']);
    expect(layouts.current).toBe('Mine');
    expect(layouts.arrangement(kArea)).toEqual(kTree);
    layouts.choose('fly');
    layouts.choose('Mine');
    layouts.remove('Mine');
    expect(layouts.current).toBe('fly');
    expect(open(storage).layouts.ownNames).toEqual([]);
  });

  it('stay when the dashboard is open twice', () => {
    const storage = new FakeStorage();
    const first = open(storage).layouts;
    const second = open(storage).layouts;
    first.saveAs('First');
    second.onRearranged(kTree);
    second.saveAs('Second');
    first.choose('fly');
    expect(first.ownNames).toEqual(['First', 'Second']);
    expect(open(storage).layouts.ownNames).toEqual(['First', 'Second']);
    expect(second.copies(['First'])).toHaveLength(1);
    second.remove('First');
    first.choose('First');
    expect(first.current, 'the other page has deleted it').toBe('fly');
    expect(first.add([{ name: 'Third', tree: kTree, look: null }])).toEqual(['Third']);
    expect(open(storage).layouts.ownNames).toEqual(['Second', 'Third']);
  });

  it('stay on the screen when another page deletes them', () => {
    const storage = new FakeStorage();
    const { layouts, arranged } = open(storage);
    layouts.saveAs('Mine');
    const other = open(storage).layouts;
    other.remove('Mine');
    other.choose('camera');
    layouts.add([]);
    expect(layouts.ownNames).toEqual([]);
    expect(layouts.shared).toEqual({ name: 'fly', tree: kTree });
    expect(arranged()).toBe(0);
  });

  it('last until the page is closed if the browser keeps no more', () => {
    const storage = new FakeStorage();
    const { layouts } = open(storage);
    layouts.saveAs('Kept');
    storage.setItem = () => {
      throw new Error('full');
    };
    layouts.saveAs('Mine');
    layouts.choose('fly');
    expect(layouts.ownNames).toEqual(['Kept', 'Mine']);
  });

  it('open the layout of a link', () => {
    const { layouts, arranged } = open(new FakeStorage());
    layouts.open({ name: null, tree: null });
    layouts.open({ name: 'fly', tree: null });
    layouts.open({ name: 'nonsense', tree: null });
    expect(arranged(), 'is shown already, or there is none').toBe(0);
    layouts.open({ name: 'camera', tree: kTree });
    expect(layouts.current).toBe('camera');
    expect(layouts.shared).toEqual({ name: 'camera', tree: kTree });
    expect(arranged()).toBe(1);
    layouts.open({ name: 'camera', tree: structuredClone(kTree) });
    expect(arranged(), 'the same again').toBe(1);
    layouts.open({ name: 'camera', tree: null });
    expect(layouts.shared).toEqual({ name: 'camera', tree: null });
    layouts.open({ name: 'nonsense', tree: kTree });
    expect(layouts.shared).toEqual({ name: 'fly', tree: kTree });
  });

  it('recognise an own layout in a link', () => {
    const { layouts } = open(new FakeStorage());
    layouts.saveAs('Mine');
    const { shared } = layouts;
    expect(shared).toEqual({ name: null, tree: kTree });
    layouts.choose('compare');
    layouts.open(shared);
    expect(layouts.current).toBe('Mine');
    expect(layouts.isChanged).toBe(false);
  });

  it.each(['', '  ', 'Fly', 'x'.repeat(41)])('refuse the name "%s"', (name) => {
    expect(open(new FakeStorage()).layouts.saveAs(name)).not.toBe(null);
  });

  it('ignore a layout that there is not', () => {
    const { layouts } = open(new FakeStorage());
    layouts.choose('nonsense');
    expect(layouts.current).toBe('fly');
  });

  const damaged: [string, string][] = [
    ['no JSON', '{"version":1'],
    ['another version', '{"version":2,"name":"camera"}'],
    ['no layout of this name', '{"version":1,"name":"gone","changed":null,"own":{}}'],
    ['an unknown panel', stored({ tabs: ['radar'], active: 'radar' })],
    ['a panel that occurs twice', stored({ tabs: ['log', 'log'], active: 'log' })],
    ['no panel in front', stored({ tabs: ['log'], active: 'runs' })],
    ['a size of zero', stored(row({ size: 0, node: { tabs: ['log'], active: 'log' } }))],
    [
      'a size that is no number',
      stored(row({ size: '4', node: { tabs: ['log'], active: 'log' } })),
    ],
    ['a row in a row', stored(row({ size: 1, node: row({ size: 1, node: kTree }) }))],
    ['a row of nothing', stored(row())],
    ['endless depth', deep(20_000)],
  ];
  it.each(damaged)('fall back to a ready-made one and say so: %s', (_what, text) => {
    const { layouts, said } = open(new FakeStorage(text));
    expect(layouts.isChanged).toBe(false);
    expect(layouts.current).toBe('fly');
    expect(said().length).toBe(1);
    expect(said()[0]).toMatch(/damaged/);
  });

  it('take own layouts that are in order from among damaged ones', () => {
    const own = { Good: kTree, Bad: { tabs: [] } };
    const text = JSON.stringify({ version: 1, name: 'Good', changed: null, own });
    const { layouts, said } = open(new FakeStorage(text));
    expect(layouts.ownNames).toEqual(['Good']);
    expect(layouts.current).toBe('Good');
    expect(said()[0]).toContain('Bad');
  });

  it('keep how the 3D view and the pictures were with an own layout', () => {
    const storage = new FakeStorage();
    const first = open(storage);
    const look = { view: 'orbit,1.0,2.0,300', show: 'image', sideBySide: false };
    first.keeper.shown = look;
    expect(first.layouts.saveAs('Mine')).toBeNull();
    first.layouts.choose('fly');
    expect(first.keeper.shown, 'a ready-made layout keeps what is shown').toBe(look);
    const { layouts, keeper } = open(storage);
    layouts.choose('Mine');
    expect(keeper.shown).toEqual(look);
  });

  it('leave out a look that is none', () => {
    const looks = { Mine: { view: 7, show: 'x'.repeat(900) }, Gone: 1 };
    const text = JSON.stringify({
      version: 1,
      name: 'Mine',
      changed: null,
      own: { Mine: kTree },
      looks,
    });
    const { layouts, keeper, said } = open(new FakeStorage(text));
    layouts.applyLook();
    expect(keeper.shown.view).toBe('');
    expect(keeper.shown.show.length).toBeLessThan(400);
    expect(said()).toEqual([]);
  });

  it('work without a storage', () => {
    const refusing = {
      getItem: (): string | null => {
        throw new Error('denied');
      },
      setItem: () => {
        throw new Error('full');
      },
    };
    const store = new Store();
    const layouts = new Layouts(
      store,
      new Notices(store, () => undefined),
      refusing,
      new FakeKeeper(),
    );
    layouts.choose('camera');
    expect(layouts.current).toBe('camera');
  });
});

function row(...parts: unknown[]) {
  return { split: 'row', parts };
}

function stored(changed: unknown): string {
  return JSON.stringify({ version: 1, name: 'fly', changed, own: {} });
}

function deep(levels: number): string {
  const kinds = ['row', 'column'];
  let open = '';
  let close = '';
  for (let i = 0; i < levels; i += 1) {
    open += `{"split":"${kinds[i % 2] ?? ''}","parts":[{"size":1,"node":`;
    close += '}]}';
  }
  const inner = JSON.stringify({ tabs: ['log'], active: 'log' });
  return `{"version":1,"name":"fly","own":{},"changed":${open}${inner}${close}}`;
}
