// A panel of the frame: made when it is first shown, redrawn only while it is visible.
import type { PanelName } from '../../store/layouts/panel_names';
import { kPanels } from '../../store/layouts/panel_names';
import { kTopics } from '../../store/state';
import type { Topic } from '../../store/state';
import { h } from '../dom';
import type { Context, View } from '../view';
import { kPanelMakers } from './panel_registry';

export class PanelHost {
  readonly element: HTMLElement;
  /** Title, tools and badges; the dock moves them next to the tab. */
  readonly header = h('div', { class: 'panel-header-place' });
  private view: View | null = null;
  private making = false;
  private visible = false;

  constructor(
    private readonly context: Context,
    readonly name: PanelName,
  ) {
    this.element = h('div', { class: 'panel-host' });
  }

  show(visible: boolean): void {
    if (visible === this.visible) return;
    this.visible = visible;
    if (!visible) this.view?.onHidden?.();
    else if (this.view === null) this.make();
    else this.view.update(kTopics);
  }

  update(changed: ReadonlySet<Topic>): void {
    if (this.visible) this.view?.update(changed);
  }

  private make(): void {
    if (this.making) return;
    this.making = true;
    const made = kPanelMakers[this.name](this.context);
    if (!(made instanceof Promise)) {
      this.take(made);
      return;
    }
    const { title } = kPanels[this.name];
    this.element.replaceChildren(h('div', { class: 'panel-empty' }, `Loading ${title}`));
    made.then(
      (view) => this.take(view),
      () => {
        this.making = false;
        this.element.replaceChildren(
          h('div', { class: 'panel-empty' }, `${title} could not be loaded. Reload the page.`),
        );
      },
    );
  }

  private take(view: View): void {
    this.view = view;
    const header = view.root.querySelector(':scope > .panel-header');
    if (header !== null) this.header.append(header);
    this.element.replaceChildren(view.root);
    if (this.visible) view.update(kTopics);
  }
}
