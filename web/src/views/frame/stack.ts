// The panels on a narrow screen: one below the other, reached by scrolling.
import { kPanelNames } from '../../store/layouts/panel_names';
import type { PanelName } from '../../store/layouts/panel_names';
import { h } from '../dom';
import type { PanelHost } from './panel_host';

/** What flies comes first, what is chosen or read comes last. */
const kOrder: readonly PanelName[] = [
  'scene',
  'camera',
  'debug',
  'depth',
  'image-error',
  'plots',
  'plots-errors',
  'errors',
];
/** Panels this near to the screen are ready when they are reached. */
const kMargin = '200px';

export class Stack {
  readonly root = h('div', { class: 'stack' });
  private shown: PanelName[] = [];
  /** Panels that are scrolled away are hidden: they need no pictures. */
  private readonly watch = new IntersectionObserver(
    (entries) => {
      for (const { target, isIntersecting } of entries) {
        const name = this.shown.find((one) => this.places.get(one) === target);
        if (name !== undefined) this.host(name).show(isIntersecting);
      }
    },
    { rootMargin: kMargin },
  );
  private readonly places = new Map<PanelName, Element>();

  constructor(private readonly host: (name: PanelName) => PanelHost) {}

  arrange(panels: readonly PanelName[]): void {
    const order = [...kOrder, ...kPanelNames.filter((name) => !kOrder.includes(name))];
    const hidden = this.shown.filter((name) => !panels.includes(name));
    this.shown = order.filter((name) => panels.includes(name));
    this.watch.disconnect();
    this.places.clear();
    for (const name of this.shown) {
      const { element, header } = this.host(name);
      this.places.set(name, h('div', { class: 'stacked', 'data-stacked': name }, header, element));
    }
    this.root.replaceChildren(...this.places.values());
    for (const name of hidden) this.host(name).show(false);
    for (const place of this.places.values()) this.watch.observe(place);
  }

  panels(): PanelName[] {
    return [...this.shown];
  }

  show(name: PanelName): void {
    if (!this.shown.includes(name)) this.arrange([...this.shown, name]);
    this.root.querySelector(`[data-stacked="${name}"]`)?.scrollIntoView({ block: 'start' });
  }

  hide(name: PanelName): void {
    this.arrange(this.shown.filter((one) => one !== name));
  }

  dispose(): void {
    this.arrange([]);
  }
}
