// The panels on a screen that is wide enough: side by side, resized and moved by the viewer.
import { createDockview } from 'dockview-core';
import type { DockviewApi, IGroupHeaderProps } from 'dockview-core';
import { sameArrangement, sameFront } from '../../store/layouts/layout_tree';
import type { LayoutNode } from '../../store/layouts/layout_tree';
import { isPanelName, kPanels } from '../../store/layouts/panel_names';
import type { PanelName } from '../../store/layouts/panel_names';
import type { Area } from '../../store/layouts/ready_layouts';
import { h, setAttribute } from '../dom';
import { icon } from '../icons';
import { fromDock, kTabComponent, toDock } from './dock_tree';
import type { PanelHost } from './panel_host';

const kGap_px = 6;
/** The library reports a movement of the mouse many times. */
const kSettle_ms = 120;

export interface DockOptions {
  host: (name: PanelName) => PanelHost;
  /** Called after the viewer has rearranged something. */
  onRearranged: (tree: LayoutNode) => void;
  /** Called once a new size of the window has settled: the library has scaled all panels by it. */
  onResized: () => void;
}

export class Dock {
  readonly root = h('div', { class: 'dock' });
  private readonly api: DockviewApi;
  private readonly sizes: ResizeObserver;
  /** As arranged last, and in which area. */
  private basis: { tree: LayoutNode | null; area: Area } | null = null;
  private timer = 0;

  constructor(private readonly options: DockOptions) {
    this.api = createDockview(this.root, {
      theme: { name: 'overfly', className: 'dock-theme', gap: kGap_px },
      disableFloatingGroups: true,
      scrollbars: 'native',
      defaultTabComponent: kTabComponent,
      createComponent: ({ name }) => this.content(name),
      createTabComponent: () => new PanelTab(),
      createRightHeaderActionComponent: () => new GroupActions(options),
      createWatermarkComponent: () => ({
        element: h('div', { class: 'dock-empty' }, 'All panels are hidden. Choose a layout above.'),
        init: () => undefined,
      }),
    });
    const settle = () => {
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => this.compare(), kSettle_ms);
    };
    this.api.onDidLayoutChange(settle);
    this.api.onDidMaximizedGroupChange(settle);
    // The library does not report a new size of the window.
    this.sizes = new ResizeObserver(settle);
    this.sizes.observe(this.root);
  }

  get area(): Area {
    return { width_px: this.root.clientWidth, height_px: this.root.clientHeight };
  }

  arrange(tree: LayoutNode): void {
    const { area } = this;
    this.api.layout(area.width_px, area.height_px, true);
    this.api.fromJSON(toDock(tree, area));
    this.basis = { tree: this.tree(), area };
  }

  /** null while no panel is on the screen. */
  tree(): LayoutNode | null {
    return fromDock(this.api.toJSON());
  }

  panels(): PanelName[] {
    return this.api.panels.map(({ id }) => id).filter(isPanelName);
  }

  show(name: PanelName): void {
    const there = this.api.getPanel(name);
    if (there !== undefined) {
      there.api.setActive();
      return;
    }
    const { title, joins } = kPanels[name];
    const beside = [...joins, ...this.panels()].find((id) => this.api.getPanel(id) !== undefined);
    this.api.addPanel({
      id: name,
      component: name,
      tabComponent: kTabComponent,
      title,
      ...(beside === undefined
        ? {}
        : { position: { referencePanel: beside, direction: 'within' as const } }),
    });
  }

  hide(name: PanelName): void {
    this.api.getPanel(name)?.api.close();
  }

  restore(): void {
    if (this.api.hasMaximizedGroup()) this.api.exitMaximizedGroup();
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.sizes.disconnect();
    this.api.dispose();
  }

  private content(name: string) {
    const element = h('div', { class: 'dock-content' });
    if (!isPanelName(name)) return { element, init: () => undefined };
    const host = this.options.host(name);
    return {
      element,
      init: ({ api }: { api: PanelVisibility }) => {
        element.append(host.element);
        host.show(api.isVisible);
        api.onDidVisibilityChange(({ isVisible }) => host.show(isVisible));
      },
      dispose: () => host.show(false),
    };
  }

  /** Tells what the viewer did from what a new size of the window did. */
  private compare(): void {
    if (this.api.hasMaximizedGroup() || this.basis === null) return;
    const { area } = this;
    const tree = this.tree();
    const resized =
      area.width_px !== this.basis.area.width_px || area.height_px !== this.basis.area.height_px;
    const before = this.basis.tree;
    this.basis = { tree, area };
    if (resized) this.options.onResized();
    if (tree === null || resized) return;
    const same = before !== null && sameArrangement(tree, before, 0.002) && sameFront(tree, before);
    if (!same) this.options.onRearranged(tree);
  }
}

interface PanelVisibility {
  isVisible: boolean;
  onDidVisibilityChange: (listener: (event: { isVisible: boolean }) => void) => unknown;
}

/** The title of a panel with a button that hides it. */
class PanelTab {
  readonly element = h('div', { class: 'panel-tab' });

  init({ title, api }: { title: string; api: { id: string; close: () => void } }): void {
    const label = `Hide ${title}`;
    this.element.append(
      h('span', { class: 'panel-tab-title' }, title),
      h(
        'button',
        {
          class: 'panel-tab-hide',
          type: 'button',
          title: label,
          'aria-label': label,
          // Otherwise the library brings the panel to the front first.
          onpointerdown: (event: PointerEvent) => event.stopPropagation(),
          onclick: (event: MouseEvent) => {
            event.stopPropagation();
            api.close();
          },
        },
        icon('close'),
      ),
    );
  }
}

/** The tools of the panel in front, and the button that enlarges it. */
class GroupActions {
  readonly element = h('div', { class: 'group-actions' });
  private readonly disposables: { dispose: () => void }[] = [];

  constructor(private readonly options: DockOptions) {}

  init({ api, containerApi, group }: IGroupHeaderProps): void {
    const label = 'Enlarge or restore';
    const enlarge = h(
      'button',
      {
        class: 'icon-button enlarge',
        type: 'button',
        title: `${label} (Esc restores)`,
        'aria-label': label,
        'aria-pressed': 'false',
        onclick: () => {
          if (api.isMaximized()) api.exitMaximized();
          else api.maximize();
        },
      },
      icon('expand'),
    );
    const place = h('div', { class: 'group-tools' });
    this.element.append(place, enlarge);
    const follow = (id: string | undefined) => {
      place.replaceChildren(...(isPanelName(id) ? [this.options.host(id).header] : []));
    };
    follow(group.activePanel?.id);
    this.disposables.push(
      api.onDidActivePanelChange(({ panel }) => follow(panel.id)),
      containerApi.onDidMaximizedGroupChange(() => {
        setAttribute(enlarge, 'aria-pressed', String(api.isMaximized()));
      }),
    );
  }

  dispose(): void {
    for (const disposable of this.disposables) disposable.dispose();
  }
}
