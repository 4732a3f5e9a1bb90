// State stored in the address bar: the layout, the runs, what is shown of them and how, and the
// instant unless the view is live. Addresses come from anywhere: what cannot be read is left out.
import { layoutOfText, layoutText } from '../layouts/layout_text';
import type { LayoutNode } from '../layouts/layout_tree';
import { LayoutError } from '../layouts/layout_tree';
import type { LinkChoices } from './link_choices';
import { nameOf, readChoices, readPart, secondsText, writeChoices } from './link_choices';
import type { TrackColour } from '../track_colours';
import { isTrackColour } from '../track_colours';
import { indexOfLetter, letterOf } from '../tracks';
import { kMostOffset_ns, kMostRuns } from '../watched_run';

export interface ShownRun {
  id: string;
  /** Time of the clock at its beginning. */
  offset_ns: number;
}

export interface LinkedRun extends ShownRun {
  /** Tracks that are not shown: names of estimators, '' = the truth. */
  hidden: ReadonlySet<string>;
  /** null = the first. */
  camera: string | null;
  /** Given to tracks by the viewer, by the names of their estimators. */
  colours: ReadonlyMap<string, TrackColour>;
}

export interface Permalink {
  /** In the order of watching. */
  runs: readonly LinkedRun[];
  /** null = the first. */
  main: string | null;
  /** Of the clock. */
  t_ns: number | null;
  /** Name of a ready-made layout; null = none is asked for. */
  layout: string | null;
  /** The arrangement if it is not that of the ready-made layout. */
  panels: LayoutNode | null;
  /** Viewpoint and contents of the 3D view (scene/scene_look.ts); '' = as usual. */
  view: string;
  show: string;
  /** Pictures of all runs, not only of the main one. */
  sideBySide: boolean;
  choices: LinkChoices;
  /** The study whose page is open, '' = the page without a study; null = it is closed. */
  study: string | null;
}

export interface ReadPermalink extends Permalink {
  /** The parts that cannot be read, for the viewer. */
  problems: string[];
}

/** Of one kind, of all runs. */
const kMostOfRuns = 1000;

/**
 * "#layout=NAME&panels=ARRANGEMENT&study=NAME&run=ID&run=ID@OFFSET&main=ID&view=VIEW&show=PARTS&
 * pictures=main&hide=A&hide=B/ESTIMATOR&camera=A/NAME&colour=3,B/ESTIMATOR&...&t=SECONDS": OFFSET
 * in seconds, by default 0; A, B, ... are the runs in their order; for the rest see
 * link_choices.ts. Unknown parts are ignored.
 */
export function parsePermalink(hash: string): ReadPermalink {
  const fields = new URLSearchParams(hash.replace(/^#/, ''));
  const problems: string[] = [];
  const named = fields.getAll('run').map((text) => shownRun(text, problems));
  const once = named.filter(
    ({ id }, i) => id !== '' && named.findIndex((run) => run.id === id) === i,
  );
  if (once.length > kMostRuns) problems.push(`more than ${kMostRuns} runs`);
  const shown = once.slice(0, kMostRuns);
  const main = fields.get('main');
  const t = fields.get('t');
  return {
    runs: linkedRuns(shown, fields, problems),
    main: main === '' ? null : main,
    t_ns: t === null || t === '' ? null : readPart('t', t, nanoseconds, problems),
    layout: fields.get('layout'),
    panels: readPanels(fields.get('panels'), problems),
    view: fields.get('view') ?? '',
    show: fields.get('show') ?? '',
    sideBySide: fields.get('pictures') !== 'main',
    choices: readChoices(fields, problems),
    study: fields.get('study'),
    problems,
  };
}

export function formatPermalink(link: Permalink): string {
  const { runs, main, t_ns, layout, panels, view, show, sideBySide, choices, study } = link;
  const fields = new URLSearchParams();
  if (layout !== null) fields.set('layout', layout);
  if (panels !== null) fields.set('panels', layoutText(panels));
  if (study !== null) fields.set('study', study);
  if (runs.length === 0) return fields.size === 0 ? '' : `#${fields.toString()}`;
  for (const { id, offset_ns } of runs) {
    fields.append('run', offset_ns === 0 ? id : `${id}@${secondsText(offset_ns)}`);
  }
  if (main !== null && main !== runs[0]?.id) fields.set('main', main);
  if (view !== '') fields.set('view', view);
  if (show !== '') fields.set('show', show);
  if (!sideBySide) fields.set('pictures', 'main');
  runs.forEach(({ hidden, camera, colours }, i) => {
    const most = kMostOfRuns / kMostRuns;
    for (const name of [...hidden].slice(0, most)) fields.append('hide', ofRun(i, name));
    for (const [name, colour] of [...colours].slice(0, most)) {
      fields.append('colour', `${colour},${ofRun(i, name)}`);
    }
    if (camera !== null) fields.append('camera', ofRun(i, camera));
  });
  writeChoices(choices, fields);
  if (t_ns !== null) fields.set('t', secondsText(t_ns));
  return `#${fields.toString()}`;
}

function linkedRuns(
  runs: readonly ShownRun[],
  fields: URLSearchParams,
  problems: string[],
): LinkedRun[] {
  const linked = runs.map((run) => ({
    ...run,
    hidden: new Set<string>(),
    camera: null as string | null,
    colours: new Map<string, TrackColour>(),
  }));
  type Take = (run: (typeof linked)[number], name: string, before: string) => boolean;
  const each = (field: string, take: Take) => {
    const texts = fields.getAll(field);
    if (texts.length > kMostOfRuns) problems.push(field);
    for (const text of texts.slice(0, kMostOfRuns)) {
      const parts = /^(?:([^,/]*),)?([A-Z])(?:\/(.{1,200}))?$/u.exec(text);
      const [, before = '', letter = '', name = ''] = parts ?? [];
      const run = linked[indexOfLetter(letter)];
      readPart(field, text, () => (run !== undefined && take(run, name, before)) || null, problems);
    }
  };
  each('hide', ({ hidden }, name, before) => {
    if (before !== '') return false;
    hidden.add(name);
    return true;
  });
  each('camera', (run, name, before) => {
    if (before !== '' || nameOf(name) === null) return false;
    run.camera = name;
    return true;
  });
  each('colour', ({ colours }, name, colour) => {
    if (!isTrackColour(colour)) return false;
    colours.set(name, colour);
    return true;
  });
  return linked;
}

/** A name that belongs to a run, '' = to the run itself. */
function ofRun(index: number, name: string): string {
  const letter = letterOf(index);
  return name === '' ? letter : `${letter}/${name}`;
}

function readPanels(text: string | null, problems: string[]): LayoutNode | null {
  if (text === null) return null;
  try {
    return layoutOfText(text);
  } catch (error) {
    if (!(error instanceof LayoutError)) throw error;
    problems.push(error.message);
    return null;
  }
}

function shownRun(text: string, problems: string[]): ShownRun {
  const [, id = text, offset] = /^(.*)@(-?[0-9.]+)$/.exec(text) ?? [];
  if (offset === undefined) return { id, offset_ns: 0 };
  return { id, offset_ns: readPart('run', text, () => offsetOf(offset), problems) ?? 0 };
}

function offsetOf(text: string): number | null {
  const offset_ns = nanoseconds(text);
  return offset_ns !== null && Math.abs(offset_ns) <= kMostOffset_ns ? offset_ns : null;
}

/** null for what is no time, or too long to be exact. */
function nanoseconds(text: string): number | null {
  const t_ns = text === '' ? NaN : Math.round(Number(text) * 1e9);
  return Number.isSafeInteger(t_ns) ? t_ns : null;
}
