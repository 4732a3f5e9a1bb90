import { describe, expect, it } from 'vitest';
import { LayoutExchange } from '../../../src/store/layouts/layout_exchange';
import type { LayoutNode } from '../../../src/store/layouts/layout_tree';
import { Layouts } from '../../../src/store/layouts/layouts';
import { Notices } from '../../../src/store/notices';
import { Store } from '../../../src/store/state';

const kTree: LayoutNode = { tabs: ['scene', 'log'], active: 'log' };
const kOther: LayoutNode = { tabs: ['plots'], active: 'plots' };

/** A browser with own layouts of these names. */
function browser(...names: string[]) {
  const store = new Store();
  let tree = kTree;
  const notices = new Notices(store, () => undefined);
  const kept = { text: null as string | null };
  const storage = {
    getItem: () => kept.text,
    setItem: (_key: string, text: string) => (kept.text = text),
  };
  const keeper = {
    look: () => ({ view: '', show: 'image', sideBySide: true }),
    apply: () => undefined,
  };
  const layouts = new Layouts(store, notices, storage, keeper);
  layouts.use({
    arrange: () => undefined,
    show: () => undefined,
    hide: () => undefined,
    panels: () => [],
    tree: () => tree,
    restore: () => undefined,
  });
  for (const name of names) layouts.saveAs(name);
  layouts.choose('fly');
  return {
    layouts,
    exchange: new LayoutExchange(layouts, notices),
    rearrange: () => (tree = kOther),
    said: () => store.state.notices.map(({ level, text }) => `${level}: ${text}`),
    reopened: () => new Layouts(store, notices, storage, keeper),
  };
}

const asFile = ({ name, text }: { name: string; text: string }) => ({
  name,
  size: text.length,
  text: () => Promise.resolve(text),
});
const exported = (from: ReturnType<typeof browser>, ...names: string[]) =>
  asFile(from.exchange.export(names));

describe('the exchange of layouts', () => {
  it('brings a layout to another browser, which shows and keeps it', async () => {
    const { layouts, exchange, said, reopened } = browser();
    await exchange.import(exported(browser('Mine'), 'Mine'));
    expect(layouts.current).toBe('Mine');
    expect(layouts.copies(['Mine'])[0]).toEqual({
      name: 'Mine',
      tree: kTree,
      look: { view: '', show: 'image', sideBySide: true },
    });
    expect(said()).toEqual(['info: Imported from Mine.layouts.json: Mine.']);
    expect(reopened().ownNames).toEqual(['Mine']);
  });

  it('shows none of several, and none over unsaved changes', async () => {
    const several = browser();
    await several.exchange.import(exported(browser('A', 'B'), 'A', 'B'));
    expect(several.layouts.ownNames).toEqual(['A', 'B']);
    expect(several.layouts.current).toBe('fly');
    const busy = browser();
    busy.layouts.onRearranged(kOther);
    await busy.exchange.import(exported(browser('A'), 'A'));
    expect(busy.layouts.current).toBe('fly');
    expect(busy.layouts.isChanged).toBe(true);
  });

  it('keeps an own layout of the same name, and adds the same one only once', async () => {
    const { layouts, exchange, said } = browser('Mine');
    await exchange.import(exported(browser('Mine'), 'Mine'));
    expect(layouts.ownNames).toEqual(['Mine']);
    const other = browser();
    other.rearrange();
    other.layouts.saveAs('Mine');
    for (let times = 0; times < 2; times += 1) {
      await exchange.import(exported(other, 'Mine'));
      expect(layouts.ownNames).toEqual(['Mine', 'Mine (2)']);
    }
    expect(layouts.current).toBe('Mine (2)');
    expect(said().at(-1)).toMatch(/Mine \(2\)\. Your own Mine differs and is kept\.$/);
    expect(layouts.copies(['Mine', 'Mine (2)']).map(({ tree }) => tree)).toEqual([kTree, kOther]);
  });

  it('numbers a name of the full length without exceeding it', async () => {
    const name = 'n'.repeat(40);
    const { layouts, exchange } = browser(name);
    const other = browser();
    other.rearrange();
    other.layouts.saveAs(name);
    await exchange.import(exported(other, name));
    expect(layouts.ownNames).toContain(`${'n'.repeat(36)} (2)`);
  });

  it('takes all of a file or nothing', async () => {
    const names = Array.from({ length: 49 }, (_, i) => `Own ${i}`);
    const { layouts, exchange, said } = browser(...names);
    await exchange.import(exported(browser('A', 'B'), 'A', 'B'));
    expect(layouts.ownNames.length).toBe(49);
    expect(said().at(-1)).toMatch(/^error: .* more than 50\. Delete some first\.$/);
    const damaged = exported(browser('A', 'B'), 'A', 'B');
    const text = (await damaged.text()).replaceAll('"log"', '"lag"');
    await exchange.import(asFile({ name: 'x.json', text }));
    expect(layouts.ownNames.length).toBe(49);
    expect(said().at(-1)).toBe(
      'error: No layout was imported from x.json. layouts[0].panels.tabs[1]: there is no panel "lag"',
    );
  });
});
