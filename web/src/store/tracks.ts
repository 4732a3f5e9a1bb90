// The tracks of the watched runs: the true one and one of each estimator.
import { kDefaultAlignment } from './errors/error_table';
import type { State } from './state';
import type { Table } from './table';
import type { TrackColour } from './track_colours';
import { colourKey } from './track_colours';
import type { WatchedRun } from './watched_run';

export interface Track {
  run: WatchedRun;
  /** Of the estimator; '' = the truth. */
  name: string;
  /** 'truth' or the estimator, with the run's letter if several runs are watched. */
  label: string;
  /** Of its run; '' if one run is watched. */
  letter: string;
  /** Index of the estimate's colour; of the truth: of its run's first estimate. */
  colour: number;
  /** Given by the viewer instead; null = none. */
  chosen: TrackColour | null;
  /** Position of its run among the watched ones. */
  order: number;
  shown: boolean;
  /** Of the estimate drawn a second time, by another alignment: that alignment. */
  by?: string;
}

/** 'A', 'B', ... by the order of watching; '' for the only run that is watched. */
export function runLetter({ watched }: Pick<State, 'watched'>, run: WatchedRun): string {
  return watched.length < 2 ? '' : letterOf(watched.indexOf(run));
}

/** 'A' for 0. */
export function letterOf(index: number): string {
  return String.fromCharCode(kLetterA + index);
}

/** -1 for what is no letter from A to Z. */
export function indexOfLetter(letter: string): number {
  return /^[A-Z]$/.test(letter) ? letter.charCodeAt(0) - kLetterA : -1;
}

const kLetterA = 'A'.charCodeAt(0);

/** All tracks, run by run; each run's truth comes first. */
export function tracksOf(state: Pick<State, 'watched' | 'colours'>): Track[] {
  let colour = 0;
  return state.watched.flatMap((run, order) => {
    const letter = runLetter(state, run);
    const prefix = letter === '' ? '' : `${letter} `;
    const names = ['', ...(run.run?.estimators ?? [])];
    return names.map((name) => ({
      run,
      name,
      letter,
      label: `${prefix}${name === '' ? 'truth' : name}`,
      colour: name === '' ? colour : colour++,
      chosen: state.colours.get(colourKey(run.id, name)) ?? null,
      order,
      shown: !run.hidden.has(name),
    }));
  });
}

/** The tracks that are drawn: those shown, then estimates by the alignment they are compared with. */
export function drawnTracks(state: Pick<State, 'watched' | 'colours'>): Track[] {
  const shown = shownTracks(state);
  return [...shown, ...shown.flatMap(secondOf)];
}

export function shownTracks(state: Pick<State, 'watched' | 'colours'>): Track[] {
  return tracksOf(state).filter(({ shown }) => shown);
}

/** The track by the second alignment; none of a truth, or while there is no second one. */
function secondOf(track: Track): Track[] {
  const { run, name, label } = track;
  if (name === '' || run.compared?.estimates.has(name) !== true) return [];
  const by = run.compared.mode;
  return [{ ...track, by, label: `${label} by ${by}` }];
}

/** Where a track was; undefined while nothing is known of it. */
export function tableOf({ run, name, by }: Track): Table | undefined {
  if (name === '') return run.data.truth;
  const rows = by === undefined ? run.shownEstimate(name) : run.compared?.estimates.get(name);
  return rows?.table;
}

/** Scale of an estimate by the alignment of its track; null if it is not scored. */
export function scaleOf({ run, name, by }: Track): number | null {
  const mode = by ?? run.aligned?.mode ?? kDefaultAlignment;
  return run.metrics?.estimators?.[name]?.alignments?.[mode]?.scale ?? null;
}
