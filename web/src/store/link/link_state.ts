// What an address holds of the screen, and the screen as an address says.
import type { Alignment } from '../alignment';
import { kUsualClock } from '../playback/clock_settings';
import { kDefaultLayout } from '../layouts/ready_layouts';
import type { Layouts } from '../layouts/layouts';
import type { LinkChoices } from './link_choices';
import type { Permalink, ReadPermalink } from './permalink';
import type { Notices } from '../notices';
import type { SceneControl } from '../scene/scene_control';
import { lookFrom, showText, viewText } from '../scene/scene_look';
import type { Session } from '../session';
import type { State, Store } from '../state';
import { colourKey, coloursOf } from '../track_colours';

/** Where an address is applied. */
export interface Linked {
  store: Store;
  session: Session;
  scene: SceneControl;
  layouts: Layouts;
  alignment: Alignment;
  notices: Notices;
}

/** null while the server has not sent where the runs are, as they were asked for. */
export function linkOf({
  store,
  layouts,
  session,
}: Pick<Linked, 'store' | 'layouts' | 'session'>): Permalink | null {
  const { state } = store;
  const { watched, runId, clock, scene, sideBySide, studyPage } = state;
  if (runId !== null && (clock === null || !session.settled)) return null;
  const { name, tree } = layouts.shared;
  return {
    runs: watched.map(({ id, offset_ns, hidden, camera }) => {
      return { id, offset_ns, hidden, camera, colours: coloursOf(state.colours, id) };
    }),
    main: runId,
    t_ns: clock === null || clock.live ? null : clock.t_ns,
    // The default one is not named while there is nothing else to link to.
    layout: name === kDefaultLayout && tree === null && runId === null ? null : name,
    panels: tree,
    view: viewText(scene),
    show: showText(scene),
    sideBySide,
    choices: choicesOf(state),
    study: studyPage.open ? (studyPage.name ?? '') : null,
  };
}

/** Shows what an address says, except the study. */
export function openLink(link: ReadPermalink, linked: Linked): void {
  const { store, session, scene, layouts, alignment, notices } = linked;
  const { state } = store;
  const { runs, main, t_ns, choices, problems } = link;
  if (problems.length > 0) {
    notices.error(`Parts of the link are damaged and were left out: ${problems.join('; ')}.`);
  }
  layouts.open({ name: link.layout, tree: link.panels });
  scene.apply(lookFrom(link.view, link.show));
  session.setSideBySide(link.sideBySide);
  session.showRuns(runs, main, t_ns, choices.clock);
  const chosen = new Map(state.colours);
  for (const { id, hidden, camera, colours } of runs) {
    const watched = state.watchedRun(id);
    if (watched === undefined) continue;
    watched.hidden = new Set(hidden);
    watched.camera = camera;
    for (const name of coloursOf(chosen, id).keys()) chosen.delete(colourKey(id, name));
    for (const [name, colour] of colours) chosen.set(colourKey(id, name), colour);
  }
  state.colours = chosen;
  const { window_s, plotGroup, debugOf, imageErrorOf, zooms } = choices;
  state.plotGroup = plotGroup;
  state.plotWindow = window_s === null ? null : { span_s: window_s, waits_ns: t_ns };
  state.debugOf = debugOf;
  state.imageErrorOf = imageErrorOf;
  state.zooms = new Map(zooms);
  store.change('run', 'rows', 'plots', 'plotTime', 'pictures', 'zoom', 'cameras');
  if (choices.alignment !== state.alignment) void alignment.choose(choices.alignment);
  if (choices.compared !== state.compared) void alignment.compare(choices.compared);
}

function choicesOf(state: State): LinkChoices {
  const { alignment, compared, plotGroup, plotWindow, clock, debugOf, imageErrorOf, zooms } = state;
  return {
    alignment,
    compared,
    plotGroup,
    window_s: plotWindow?.span_s ?? null,
    clock: clock ?? kUsualClock,
    debugOf,
    imageErrorOf,
    zooms,
  };
}
