// An arrangement in the form in which the dock library reads and writes it.
import { Orientation } from 'dockview-core';
import type { SerializedDockview } from 'dockview-core';
import type { LayoutNode, Part, Split } from '../../store/layouts/layout_tree';
import { panelsOf } from '../../store/layouts/layout_tree';
import { isPanelName, kPanels } from '../../store/layouts/panel_names';
import type { Area } from '../../store/layouts/ready_layouts';

type Grid = SerializedDockview['grid'];
type GridNode = Grid['root'];

export const kTabComponent = 'panel-tab';
const kLeast_px = { minimumWidth: 150, minimumHeight: 80 };

export function toDock(tree: LayoutNode, area: Area): SerializedDockview {
  const root: Split = 'tabs' in tree ? { split: 'row', parts: [{ size: 1, node: tree }] } : tree;
  const groups = { count: 0 };
  const panels = panelsOf(tree).map((name) => [
    name,
    {
      id: name,
      contentComponent: name,
      tabComponent: kTabComponent,
      title: kPanels[name].title,
      ...kLeast_px,
    },
  ]);
  return {
    grid: {
      root: gridNode(root, area, groups),
      width: area.width_px,
      height: area.height_px,
      orientation: root.split === 'row' ? Orientation.HORIZONTAL : Orientation.VERTICAL,
    },
    panels: Object.fromEntries(panels) as SerializedDockview['panels'],
  };
}

function gridNode(node: LayoutNode, area: Area, groups: { count: number }): GridNode {
  if ('tabs' in node) {
    groups.count += 1;
    const { tabs, active } = node;
    return { type: 'leaf', data: { id: String(groups.count), views: tabs, activeView: active } };
  }
  const row = node.split === 'row';
  const whole = node.parts.reduce((sum, { size }) => sum + size, 0);
  return {
    type: 'branch',
    size: row ? area.height_px : area.width_px,
    data: node.parts.map((part) => {
      const share = part.size / whole;
      const inner = row
        ? { ...area, width_px: area.width_px * share }
        : { ...area, height_px: area.height_px * share };
      const size = row ? inner.width_px : inner.height_px;
      return { ...gridNode(part.node, inner, groups), size };
    }),
  };
}

/** @return null if no panel is on the screen */
export function fromDock({ grid }: SerializedDockview): LayoutNode | null {
  return treeNode(grid.root, grid.orientation === Orientation.HORIZONTAL);
}

function treeNode(node: GridNode, row: boolean): LayoutNode | null {
  if (!Array.isArray(node.data)) {
    const { views, activeView } = node.data;
    const tabs = views.filter(isPanelName);
    const active = tabs.find((name) => name === activeView) ?? tabs[0];
    return active === undefined ? null : { tabs, active };
  }
  const parts: Part[] = [];
  for (const child of node.data) {
    const inner = treeNode(child, !row);
    if (inner !== null) parts.push({ size: Math.max(1, Math.round(child.size ?? 1)), node: inner });
  }
  return parts.length === 0 ? null : { split: row ? 'row' : 'column', parts };
}
