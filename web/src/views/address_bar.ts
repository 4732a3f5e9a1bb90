// Synchronises the address bar and the store, so that a copied address shows the same run and
// instant.
import { formatPermalink, parsePermalink } from '../store/permalink';
import { lookFrom, showText, viewText } from '../store/scene/scene_look';
import { kDefaultLayout } from '../store/layouts/ready_layouts';
import type { Context } from './view';

const kWrite_ms = 400;

export function followAddress(context: Context): void {
  const { store, session, layouts, studies } = context;
  const open = () => {
    const link = parsePermalink(location.hash);
    const { runs, main, t_ns, layout, view, show, sideBySide, study } = link;
    if (layout !== null && layout !== layouts.shared) layouts.choose(layout);
    context.scene.apply(lookFrom(view, show));
    session.setSideBySide(sideBySide);
    session.showRuns(runs, main, t_ns);
    if (study !== null) void studies.openAt(study);
    else if (store.state.studyPage.open) studies.close();
  };
  window.addEventListener('hashchange', open);
  if (location.hash !== '') open();
  window.setInterval(() => {
    const { watched, runId, clock, scene, sideBySide, studyPage } = store.state;
    if (runId !== null && clock === null) return;
    const t_ns = clock === null || clock.live ? null : clock.t_ns;
    const hash = formatPermalink({
      runs: watched,
      main: runId,
      t_ns,
      layout: layoutToShow(context),
      view: viewText(scene),
      show: showText(scene),
      sideBySide,
      study: studyPage.open ? (studyPage.name ?? '') : null,
    });
    if (hash !== location.hash)
      history.replaceState(null, '', hash === '' ? location.pathname : hash);
  }, kWrite_ms);
}

/** The default one is not named while there is nothing else to link to. */
function layoutToShow({ store, layouts }: Context): string | null {
  const { shared } = layouts;
  return shared === kDefaultLayout && store.state.runId === null ? null : shared;
}
