// The tracks of the watched runs: the true one and one of each estimator.
import type { State } from './state';
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
}

/** 'A', 'B', ... by the order of watching; '' for the only run that is watched. */
export function runLetter({ watched }: Pick<State, 'watched'>, run: WatchedRun): string {
  return watched.length < 2 ? '' : String.fromCharCode(65 + watched.indexOf(run));
}

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
