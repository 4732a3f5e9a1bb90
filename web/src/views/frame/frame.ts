// Shows the panels of the current layout: in a dock, or on a narrow screen one below the other.
import type { LayoutNode } from '../../store/layouts/layout_tree';
import { panelsOf } from '../../store/layouts/layout_tree';
import type { Arranger } from '../../store/layouts/layouts';
import type { PanelName } from '../../store/layouts/panel_names';
import type { Topic } from '../../store/state';
import { h } from '../dom';
import { focusAgain, focusIn } from '../focus';
import type { Context, View } from '../view';
import { Dock } from './dock';
import { PanelHost } from './panel_host';
import { Stack } from './stack';

/** As in styles/narrow.css. */
const kNarrow = '(max-width: 899.98px)';

export class Frame implements View, Arranger {
  readonly root = h('main', { class: 'frame', 'aria-label': 'Panels' });
  private readonly hosts = new Map<PanelName, PanelHost>();
  private readonly narrow = window.matchMedia(kNarrow);
  private dock: Dock | null = null;
  private stack: Stack | null = null;

  constructor(private readonly context: Context) {
    context.layouts.use(this);
    this.narrow.addEventListener('change', () => this.fit());
  }

  /** To be called once the root is on the page: the dock needs its size. */
  fit(): void {
    const tree = this.stack === null && this.dock === null ? null : this.tree();
    this.stack?.dispose();
    this.stack = null;
    this.dock?.dispose();
    this.dock = null;
    this.root.replaceChildren();
    const host = (name: PanelName) => this.host(name);
    if (this.narrow.matches) {
      this.stack = new Stack(host);
      this.root.append(this.stack.root);
    } else {
      this.dock = new Dock({
        host,
        onRearranged: (rearranged) => this.context.layouts.onRearranged(rearranged),
        onResized: () => this.arrangeAgain(),
      });
      this.root.append(this.dock.root);
    }
    const { layouts } = this.context;
    if (tree !== null && layouts.isChanged) this.apply(tree);
    else this.arrange();
  }

  update(changed: ReadonlySet<Topic>): void {
    for (const host of this.hosts.values()) host.update(changed);
  }

  arrange(): void {
    this.apply(this.context.layouts.arrangement(this.area()));
  }

  tree(): LayoutNode {
    return this.dock?.tree() ?? this.context.layouts.arrangement(this.area());
  }

  panels(): readonly PanelName[] {
    return this.dock?.panels() ?? this.stack?.panels() ?? [];
  }

  show(name: PanelName): void {
    this.dock?.show(name);
    this.stack?.show(name);
    this.context.store.change('layout');
  }

  hide(name: PanelName): void {
    this.dock?.hide(name);
    this.stack?.hide(name);
    this.context.store.change('layout');
  }

  restore(): void {
    this.dock?.restore();
  }

  private apply(tree: LayoutNode): void {
    this.dock?.arrange(tree);
    this.stack?.arrange(panelsOf(tree));
    this.context.store.change('layout');
  }

  /** A layout is made for the size of the window. What the viewer has arranged keeps its proportions. */
  private arrangeAgain(): void {
    if (this.context.layouts.isChanged) return;
    const focused = focusIn(this.root);
    this.arrange();
    if (focused !== null) focusAgain(this.root, focused);
  }

  private area() {
    return this.dock?.area ?? { width_px: 1280, height_px: 720 };
  }

  private host(name: PanelName): PanelHost {
    const known = this.hosts.get(name) ?? new PanelHost(this.context, name);
    this.hosts.set(name, known);
    return known;
  }
}
