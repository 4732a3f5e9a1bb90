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
  'plots',
  'plots-errors',
  'errors',
];

export class Stack {
  readonly root = h('div', { class: 'stack' });
  private shown: PanelName[] = [];

  constructor(private readonly host: (name: PanelName) => PanelHost) {}

  arrange(panels: readonly PanelName[]): void {
    const order = [...kOrder, ...kPanelNames.filter((name) => !kOrder.includes(name))];
    const hidden = this.shown.filter((name) => !panels.includes(name));
    this.shown = order.filter((name) => panels.includes(name));
    this.root.replaceChildren(
      ...this.shown.map((name) => {
        const { element, header } = this.host(name);
        return h('div', { class: 'stacked', 'data-stacked': name }, header, element);
      }),
    );
    for (const name of hidden) this.host(name).show(false);
    for (const name of this.shown) this.host(name).show(true);
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
