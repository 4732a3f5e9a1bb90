// State stored in the address bar: the layout, the runs, and the instant unless the view is live.

export interface ShownRun {
  id: string;
  /** Time of the clock at its beginning. */
  offset_ns: number;
}

export interface Permalink {
  /** In the order of watching. */
  runs: ShownRun[];
  /** null = the first. */
  main: string | null;
  /** Of the clock. */
  t_ns: number | null;
  /** Name of a ready-made layout; null = none is asked for. */
  layout: string | null;
  /** Viewpoint and contents of the 3D view (scene/scene_look.ts); '' = as usual. */
  view: string;
  show: string;
  /** Pictures of all runs, not only of the main one. */
  sideBySide: boolean;
  /** The study whose page is open, '' = the page without a study; null = it is closed. */
  study: string | null;
}

/**
 * "#layout=NAME&study=NAME&run=ID&run=ID@OFFSET&main=ID&view=VIEW&show=PARTS&pictures=main&t=SECONDS": OFFSET in
 * seconds, by default 0. Unknown parts are ignored.
 */
export function parsePermalink(hash: string): Permalink {
  const fields = new URLSearchParams(hash.replace(/^#/, ''));
  const runs = fields.getAll('run').map(shownRun);
  const main = fields.get('main');
  return {
    runs: runs.filter(({ id }, i) => id !== '' && runs.findIndex((run) => run.id === id) === i),
    main: main === '' ? null : main,
    t_ns: nanoseconds(fields.get('t')),
    layout: fields.get('layout'),
    view: fields.get('view') ?? '',
    show: fields.get('show') ?? '',
    sideBySide: fields.get('pictures') !== 'main',
    study: fields.get('study'),
  };
}

export function formatPermalink(link: Permalink): string {
  const { runs, main, t_ns, layout, view, show, sideBySide, study } = link;
  const fields = new URLSearchParams();
  if (layout !== null) fields.set('layout', layout);
  if (study !== null) fields.set('study', study);
  if (runs.length === 0) return fields.size === 0 ? '' : `#${fields.toString()}`;
  for (const { id, offset_ns } of runs) {
    fields.append('run', offset_ns === 0 ? id : `${id}@${(offset_ns / 1e9).toFixed(3)}`);
  }
  if (main !== null && main !== runs[0]?.id) fields.set('main', main);
  if (view !== '') fields.set('view', view);
  if (show !== '') fields.set('show', show);
  if (!sideBySide) fields.set('pictures', 'main');
  if (t_ns !== null) fields.set('t', (t_ns / 1e9).toFixed(3));
  return `#${fields.toString()}`;
}

function shownRun(text: string): ShownRun {
  const [, id = text, offset] = /^(.*)@(-?[0-9.]+)$/.exec(text) ?? [];
  return { id, offset_ns: nanoseconds(offset ?? null) ?? 0 };
}

function nanoseconds(text: string | null): number | null {
  const seconds = text === null || text === '' ? NaN : Number(text);
  return Number.isFinite(seconds) ? Math.round(seconds * 1e9) : null;
}
