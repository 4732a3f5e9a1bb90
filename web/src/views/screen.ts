// The layout of the screen.
import { CameraPanel } from './camera_panel';
import { ConnectDialog } from './vehicle/connect_dialog';
import { ErrorPanel } from './error_panel';
import { h } from './dom';
import { HeaderBar } from './header_bar';
import { HelpOverlay } from './help_overlay';
import { Launcher } from './launcher';
import { LogPanel } from './log_panel';
import { LogPageView } from './logs/log_page';
import { NoticesView } from './notices_view';
import { DebugPanel } from './picture_panel';
import { PlotsPanel } from './plots/plots_panel';
import { RunList } from './run_list';
import { ScenarioEditor } from './scenario_editor';
import { ScenePanel } from './scene_panel';
import { listenToKeys } from './shortcuts';
import { Timeline } from './timeline';
import { VehicleCard } from './vehicle/vehicle_card';
import type { Context, View } from './view';

const kEverything = new Set([
  'connection',
  'lists',
  'launch',
  'run',
  'rows',
  'log',
  'metrics',
  'estimators',
  'playback',
  'pictures',
  'scene',
  'cameras',
  'sensors',
  'notices',
  'help',
  'logs',
] as const);

/** Builds the screen and redraws changed parts, at most once per frame. */
export function showScreen(context: Context, place: HTMLElement): void {
  const header = new HeaderBar(context);
  const left = [new Launcher(context), new RunList(context), new LogPanel(context)];
  const centre = [new ScenePanel(context), new PlotsPanel(context)];
  const vehicle = new VehicleCard(context);
  centre[0]?.root.querySelector('.panel-body')?.append(vehicle.root);
  const right = [new CameraPanel(context), new DebugPanel(context), new ErrorPanel(context)];
  const timeline = new Timeline(context);
  const above = [
    new LogPageView(context),
    new ConnectDialog(context),
    new NoticesView(context),
    new HelpOverlay(context),
    new ScenarioEditor(context),
  ];
  const views: View[] = [vehicle, header, ...left, ...centre, ...right, timeline, ...above];
  const column = (name: string, parts: View[]) =>
    h('div', { class: `column ${name}` }, ...parts.map(({ root }) => root));
  place.replaceChildren(
    header.root,
    h(
      'main',
      { class: 'columns' },
      column('left', left),
      column('centre', centre),
      column('right', right),
    ),
    timeline.root,
    ...above.map(({ root }) => root),
  );
  listenToKeys(context);
  for (const view of views) view.update(kEverything);
  context.store.onChange(() => {
    requestAnimationFrame(() => {
      const changed = context.store.take();
      for (const view of views) view.update(changed);
    });
  });
}
