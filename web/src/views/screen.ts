// The parts of the screen: header, panels, timeline, and what lies over them.
import { Frame } from './frame/frame';
import { HeaderBar } from './header_bar';
import { HelpOverlay } from './commands/help_overlay';
import { NoticesView } from './notices_view';
import { guardChanges, showAccess } from './access';
import { acceptFiles, makePages } from './pages';
import { Palette } from './commands/palette';
import { listenToKeys } from './commands/shortcuts';
import { Timeline } from './timeline';
import { ConnectDialog } from './vehicle/connect_dialog';
import { kTopics } from '../store/state';
import type { Context, View } from './view';

/** Builds the screen and redraws changed parts, at most once per frame. */
export function showScreen(context: Context, place: HTMLElement): void {
  const frame = new Frame(context);
  const dashboard: View[] = [new HeaderBar(context), frame, new Timeline(context)];
  const covered = dashboard.map(({ root }) => root);
  const views: View[] = [
    ...dashboard,
    ...makePages(context, covered),
    new ConnectDialog(context),
    new NoticesView(context),
    new HelpOverlay(context),
    new Palette(context),
  ];
  place.replaceChildren(...views.map(({ root }) => root));
  frame.fit();
  listenToKeys(context);
  acceptFiles(context);
  guardChanges(context.store.state);
  for (const view of views) view.update(kTopics);
  const draw = () => {
    const changed = context.store.take();
    if (changed.size === 0) return;
    // Also for panels that are hidden: plots and the 3D view follow the chosen alignment.
    if (changed.has('metrics') || changed.has('run')) void context.alignment.refresh();
    showAccess(context.store.state.access);
    for (const view of views) view.update(changed);
  };
  context.store.onChange((when) => {
    if (when === 'now') draw();
    else requestAnimationFrame(draw);
  });
}
