// The layouts that come with the dashboard. Sizes are in pixels of the area that they fill.
import type { LayoutNode, Part, Split, Tabs } from './layout_tree';
import type { PanelName } from './panel_names';

export interface Area {
  width_px: number;
  height_px: number;
}

export interface ReadyLayout {
  /** In addresses. */
  name: string;
  title: string;
  hint: string;
  arrange: (area: Area) => LayoutNode;
}

/** From this width on the fonts are larger (layout.css), and with them the columns of forms. */
const kWide_px = 1600;

/** Several tabs leave less room for the tools next to them. */
const kTabs_px = 40;

export const kReadyLayouts: readonly ReadyLayout[] = [
  { name: 'fly', title: 'Fly', hint: 'Launch a flight and watch it', arrange: fly },
  {
    name: 'compare',
    title: 'Compare',
    hint: 'Several runs or estimators side by side: curves and scores',
    arrange: compare,
  },
  {
    name: 'estimator',
    title: 'Debug an estimator',
    hint: 'What an estimator sees, how it is doing, what it says',
    arrange: estimator,
  },
  {
    name: 'camera',
    title: 'Camera',
    hint: 'The picture, large, with its depth and errors, and what it is like',
    arrange: camera,
  },
];

export const kDefaultLayout = 'fly';

export function readyLayout(name: string): ReadyLayout | undefined {
  return kReadyLayouts.find((layout) => layout.name === name);
}

function fly(area: Area): LayoutNode {
  const side_px = sideWidth(area);
  // As wide as possible for two 4:3 pictures above the table.
  const right_px = clamp((area.height_px - 356) * 0.6667, 324, 620);
  const log_px = Math.max(80, 0.15 * area.height_px);
  // The launch form scrolls between its head and its buttons; a whole run and the next one are seen below it.
  const launch_px = Math.max(200, Math.min(area.height_px - log_px - 200, 500));
  return split('row', [
    [
      side_px,
      split('column', [
        [launch_px, tabs('launcher')],
        [Math.max(100, area.height_px - log_px - launch_px), tabs('runs')],
        [log_px, tabs('log')],
      ]),
    ],
    [
      area.width_px - side_px - right_px,
      split('column', [
        [54, tabs('scene')],
        [46, tabs('plots')],
      ]),
    ],
    [right_px, split('column', beside(area, 290, tabs('camera'), tabs('debug'), tabs('errors')))],
  ]);
}

function compare(area: Area): LayoutNode {
  const side_px = sideWidth(area);
  const right_px = clamp(area.width_px * 0.32, 330, 680);
  return split('row', [
    [side_px + kTabs_px, tabs('runs', 'launcher', 'log')],
    [
      area.width_px - side_px - kTabs_px - right_px,
      split('column', [
        [45, tabs('scene', 'plot3d', 'camera')],
        [55, tabs('plots')],
      ]),
    ],
    [
      right_px,
      split('column', [
        [50, tabs('errors')],
        [50, tabs('plots-errors')],
      ]),
    ],
  ]);
}

function estimator(area: Area): LayoutNode {
  const right_px = clamp(area.width_px * 0.37, 400, 740);
  const left_px = area.width_px - right_px;
  return split('row', [
    [
      left_px,
      split('column', [
        [
          52,
          split('row', [
            [50, tabs('debug')],
            [50, tabs('camera', 'image-error', 'depth')],
          ]),
        ],
        [48, tabs('plots-errors', 'plots')],
      ]),
    ],
    [
      right_px,
      split('column', [
        [30, tabs('status')],
        [42, tabs('errors')],
        [28, tabs('log', 'runs', 'launcher')],
      ]),
    ],
  ]);
}

function camera(area: Area): LayoutNode {
  const side_px = sideWidth(area);
  const right_px = clamp(area.width_px * 0.3, 320, 640);
  return split('row', [
    [side_px + kTabs_px, tabs('runs', 'launcher', 'log')],
    [
      area.width_px - side_px - kTabs_px - right_px,
      split('column', [
        [62, tabs('camera')],
        [
          38,
          split('row', [
            [50, tabs('depth')],
            [50, tabs('image-error', 'debug')],
          ]),
        ],
      ]),
    ],
    [
      right_px,
      split('column', [
        [42, tabs('scene')],
        [58, tabs('plots-image')],
      ]),
    ],
  ]);
}

function sideWidth({ width_px }: Area): number {
  return width_px >= kWide_px ? 312 : 272;
}

/** Two equal parts above one of a fixed height. */
function beside(area: Area, below_px: number, a: Tabs, b: Tabs, below: Tabs): [number, Tabs][] {
  const half_px = Math.max(120, (area.height_px - below_px) / 2);
  return [
    [half_px, a],
    [half_px, b],
    [below_px, below],
  ];
}

function tabs(...names: [PanelName, ...PanelName[]]): Tabs {
  return { tabs: names, active: names[0] };
}

function split(direction: Split['split'], parts: [number, LayoutNode][]): Split {
  return { split: direction, parts: parts.map(([size, node]): Part => ({ size, node })) };
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(high, Math.max(low, value));
}
