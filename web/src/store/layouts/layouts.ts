// Which layout is shown. It is kept by the browser, with the viewer's own layouts.
import type { Notices } from '../notices';
import type { Store } from '../state';
import type { LayoutNode } from './layout_tree';
import { readLayout, sameArrangement, sameFront } from './layout_tree';
import type { PanelName } from './panel_names';
import type { Area } from './ready_layouts';
import { kDefaultLayout, readyLayout } from './ready_layouts';

const kKey = 'overfly.layouts';
const kVersion = 1;
export const kMostOwn = 50;
export const kLongestLook = 300;
export const kLongestName = 40;

export type Storage = Pick<globalThis.Storage, 'getItem' | 'setItem'>;

/** What a layout keeps of the 3D view and the pictures, as in an address. */
export interface LayoutLook {
  view: string;
  show: string;
  sideBySide: boolean;
}

/** An own layout, as it is passed on. */
export interface OwnLayout {
  name: string;
  tree: LayoutNode;
  /** null = the 3D view and the pictures stay as they are. */
  look: LayoutLook | null;
}

/** A layout that any browser can show. */
export interface SharedLayout {
  /** Of a ready-made layout; null for an own one. */
  name: string | null;
  /** null = as the ready-made layout is. */
  tree: LayoutNode | null;
}

/** Where the look comes from, and where it goes. */
export interface LookKeeper {
  look(): LayoutLook;
  apply(look: LayoutLook): void;
}

/** The part of the screen that shows the panels. */
export interface Arranger {
  /** Shows the current layout from its beginning. */
  arrange(): void;
  show(panel: PanelName): void;
  hide(panel: PanelName): void;
  /** Panels of the layout, also those behind others. */
  panels(): readonly PanelName[];
  tree(): LayoutNode;
  /** Undoes the enlargement of a panel. */
  restore(): void;
}

export class Layouts {
  /** Of a ready-made layout, or the title of an own one. */
  private name = kDefaultLayout;
  /** What the viewer has made of the layout; null = nothing changed. */
  private changed: LayoutNode | null = null;
  private own = new Map<string, LayoutNode>();
  /** Of own layouts. */
  private looks = new Map<string, LayoutLook>();
  /** The browser refused to keep the last change. */
  private unkept = false;
  private arranger: Arranger | null = null;
  private kept: () => void = () => undefined;

  constructor(
    private readonly store: Store,
    private readonly notices: Notices,
    private readonly storage: Storage,
    private readonly keeper: LookKeeper,
  ) {
    this.read();
  }

  use(arranger: Arranger): void {
    this.arranger = arranger;
  }

  /** Calls back whenever something was kept, for an address that must not be older. */
  onKept(listener: () => void): void {
    this.kept = listener;
  }

  get current(): string {
    return this.name;
  }

  get isChanged(): boolean {
    return this.changed !== null;
  }

  get title(): string {
    return this.own.has(this.name) ? this.name : (readyLayout(this.name)?.title ?? this.name);
  }

  get ownNames(): string[] {
    return [...this.own.keys()].sort((a, b) => a.localeCompare(b));
  }

  /** For an address. */
  get shared(): SharedLayout {
    return {
      name: this.own.has(this.name) ? null : this.name,
      tree: this.changed ?? this.own.get(this.name) ?? null,
    };
  }

  /** Shows the layout of an address, which may be an own one of this browser. */
  open({ name, tree }: SharedLayout): void {
    this.readAgain();
    const { shared } = this;
    if (tree === null) {
      if (name !== null && (name !== shared.name || shared.tree !== null)) this.choose(name);
      return;
    }
    if (shared.tree !== null && sameLayout(shared.tree, tree)) return;
    const own = [...this.own].find(([, kept]) => sameLayout(kept, tree));
    if (own !== undefined) {
      this.choose(own[0]);
      return;
    }
    this.name = name !== null && readyLayout(name) !== undefined ? name : kDefaultLayout;
    this.changed = tree;
    this.keep();
    this.arranger?.arrange();
  }

  arrangement(area: Area): LayoutNode {
    const kept = this.changed ?? this.own.get(this.name);
    const ready = readyLayout(this.name) ?? readyLayout(kDefaultLayout);
    if (kept !== undefined) return kept;
    if (ready === undefined) throw new Error('there is no default layout');
    return ready.arrange(area);
  }

  /** Shows a layout from its beginning; does nothing if there is none of this name. */
  choose(name: string): void {
    this.readAgain();
    if (readyLayout(name) !== undefined || this.own.has(name)) this.begin(name);
    else this.store.change('layout');
  }

  private begin(name: string): void {
    this.name = name;
    this.changed = null;
    this.keep();
    this.arranger?.arrange();
    this.applyLook();
  }

  /** Shows the 3D view and the pictures as they were when the layout was kept. */
  applyLook(): void {
    const look = this.looks.get(this.name);
    if (look !== undefined) this.keeper.apply(look);
  }

  /** Undoes what the viewer changed. */
  reset(): void {
    this.choose(this.name);
  }

  /** Keeps the arrangement of the screen as it is now. */
  onRearranged(tree: LayoutNode | null): void {
    this.readAgain();
    this.changed = tree;
    this.keep();
  }

  /** @return why the name cannot be used, or null */
  saveAs(title: string): string | null {
    const name = title.trim();
    const tree = this.arranger?.tree();
    if (tree === undefined) return 'There is nothing to keep yet.';
    const problem = nameProblem(name);
    if (problem !== null) return problem;
    this.readAgain();
    if (!this.own.has(name) && this.own.size >= kMostOwn) {
      return `There are ${kMostOwn} layouts already: delete one first.`;
    }
    this.own.set(name, tree);
    this.looks.set(name, this.keeper.look());
    this.name = name;
    this.changed = null;
    this.keep();
    return null;
  }

  /** The own layouts of these names. */
  copies(names: readonly string[]): OwnLayout[] {
    return names.flatMap((name) => {
      const tree = this.own.get(name);
      return tree === undefined ? [] : [{ name, tree, look: this.looks.get(name) ?? null }];
    });
  }

  /**
   * Adds own layouts, all or none. One that differs from the own one of its name gets a number behind
   * the name.
   * @return their names; null if there would be more than kMostOwn
   */
  add(layouts: readonly OwnLayout[]): string[] | null {
    this.readAgain();
    const own = new Map(this.own);
    const looks = new Map(this.looks);
    const names = layouts.map(({ name, tree, look }) => {
      let place = name;
      for (
        let number = 2;
        own.has(place) && !this.holds({ name: place, tree, look });
        number += 1
      ) {
        place = numbered(name, number);
      }
      own.set(place, tree);
      if (look !== null) looks.set(place, look);
      return place;
    });
    if (own.size > kMostOwn) return null;
    this.own = own;
    this.looks = looks;
    this.keep();
    return names;
  }

  private holds(layout: OwnLayout): boolean {
    return JSON.stringify(this.copies([layout.name])[0]) === JSON.stringify(layout);
  }

  remove(name: string): void {
    this.readAgain();
    this.own.delete(name);
    this.looks.delete(name);
    if (this.name === name && readyLayout(name) === undefined) this.begin(kDefaultLayout);
    else this.keep();
  }

  show(panel: PanelName): void {
    this.arranger?.show(panel);
  }

  hide(panel: PanelName): void {
    this.arranger?.hide(panel);
  }

  panels(): readonly PanelName[] {
    return this.arranger?.panels() ?? [];
  }

  restore(): void {
    this.arranger?.restore();
  }

  private keep(): void {
    const kept = {
      version: kVersion,
      name: this.name,
      changed: this.changed,
      own: Object.fromEntries(this.own),
      looks: Object.fromEntries(this.looks),
    };
    try {
      this.storage.setItem(kKey, JSON.stringify(kept));
      this.unkept = false;
    } catch {
      // Without storage, or with a full one, the layout lasts until the page is closed.
      this.unkept = true;
    }
    this.store.change('layout');
    this.kept();
  }

  private read(): void {
    const text = this.stored();
    if (text === null) return;
    const lost = this.take(readKept(text));
    if (lost.length === 0) return;
    this.notices.error(`Stored layouts are damaged and were left out: ${lost.join(', ')}.`);
  }

  /** Other pages of this browser change own layouts too. What this page shows stays as it is. */
  private readAgain(): void {
    const text = this.unkept ? null : this.stored();
    const kept = text === null ? null : readKept(text);
    if (kept === null) return;
    const shown = this.own.get(this.name);
    this.own = kept.own;
    this.looks = kept.looks;
    const now = this.own.get(this.name);
    if (shown === undefined || (now !== undefined && sameLayout(now, shown))) return;
    this.changed ??= shown;
    if (now === undefined) this.name = kDefaultLayout;
  }

  private stored(): string | null {
    try {
      return this.storage.getItem(kKey);
    } catch {
      return null;
    }
  }

  /** Takes what is in order. @return what is not */
  private take(kept: Kept | null): string[] {
    if (kept === null) return ['all'];
    const { name, changed, lost } = kept;
    this.own = kept.own;
    this.looks = kept.looks;
    if (readyLayout(name) === undefined && !this.own.has(name)) {
      return lost.length > 0 ? lost : [name.slice(0, kLongestName)];
    }
    this.name = name;
    if (changed === null || changed === undefined) return lost;
    this.changed = readLayout(changed);
    if (this.changed === null) lost.push(this.title);
    return lost;
  }
}

/** What the browser keeps; the arrangement of the screen is not checked yet. */
interface Kept {
  name: string;
  changed: unknown;
  own: Map<string, LayoutNode>;
  looks: Map<string, LayoutLook>;
  /** Names of own layouts that are not in order. */
  lost: string[];
}

/** null if nothing can be read. */
function readKept(text: string): Kept | null {
  const kept = parsed(text);
  if (typeof kept !== 'object' || kept === null) return null;
  const { version, name, changed, own, looks } = kept as Record<string, unknown>;
  if (version !== kVersion || typeof name !== 'string') return null;
  const read: Kept = { name, changed, own: new Map(), looks: new Map(), lost: [] };
  const entries = typeof own === 'object' && own !== null ? Object.entries(own) : [];
  for (const [title, value] of entries.slice(0, kMostOwn)) {
    const tree = title.length > kLongestName ? null : readLayout(value);
    if (tree === null) {
      read.lost.push(title.slice(0, kLongestName));
      continue;
    }
    read.own.set(title, tree);
    const look = readLook(looks, title);
    if (look !== null) read.looks.set(title, look);
  }
  return read;
}

function sameLayout(a: LayoutNode, b: LayoutNode): boolean {
  return sameArrangement(a, b) && sameFront(a, b);
}

/** Why an own layout cannot have this name, or null. */
export function nameProblem(name: string): string | null {
  if (name === '') return 'A layout needs a name.';
  if (name.length > kLongestName) return `A name has at most ${kLongestName} characters.`;
  if (readyLayout(name.toLowerCase()) !== undefined) return `${name} is a ready-made layout.`;
  return null;
}

function numbered(name: string, number: number): string {
  const end = ` (${number})`;
  return name.slice(0, kLongestName - end.length) + end;
}

/** What is wrong in the texts is left out when they are applied. */
function readLook(looks: unknown, title: string): LayoutLook | null {
  if (typeof looks !== 'object' || looks === null || !Object.hasOwn(looks, title)) return null;
  const look = (looks as Record<string, unknown>)[title];
  if (typeof look !== 'object' || look === null) return null;
  const { view, show, sideBySide } = look as Record<string, unknown>;
  const text = (value: unknown) => (typeof value === 'string' ? value.slice(0, kLongestLook) : '');
  return { view: text(view), show: text(show), sideBySide: sideBySide !== false };
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(text) as unknown;
  } catch {
    return null;
  }
}
