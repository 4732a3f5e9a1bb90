// Tracking states of an estimate as spans of time.
import type { EstimateRows } from './run_data';
import type { State } from './state';
import { lastAtOrBefore } from './table';
import type { Track } from './tracks';
import { tracksOf } from './tracks';

export interface StateSpan {
  state: string;
  begin_ns: number;
  /** The stamp at which the next span begins; of the last span, that of its last row. */
  end_ns: number;
}

interface Known {
  generation: number;
  taken: number;
  spans: StateSpan[];
}

const known = new WeakMap<EstimateRows, Known>();

/**
 * Reads only the rows added since the last call.
 * @param generation  of the rows: they are read again if it differs
 */
export function stateSpans(rows: EstimateRows, generation: number): readonly StateSpan[] {
  let have = known.get(rows);
  if (have?.generation !== generation) {
    have = { generation, taken: 0, spans: [] };
    known.set(rows, have);
  }
  const stamps = rows.table.column('t_ns');
  const { spans } = have;
  for (; have.taken < stamps.length; have.taken += 1) {
    const t_ns = stamps[have.taken] ?? 0;
    const state = rows.states[have.taken] ?? '';
    const last = spans.at(-1);
    if (last !== undefined) last.end_ns = t_ns;
    if (last?.state !== state) spans.push({ state, begin_ns: t_ns, end_ns: t_ns });
  }
  return spans;
}

/** The span of a time; undefined before the first and after the last. */
export function spanAt(spans: readonly StateSpan[], t_ns: number): StateSpan | undefined {
  const begins = spans.map(({ begin_ns }) => begin_ns);
  const found = spans[lastAtOrBefore(begins, t_ns)];
  return found !== undefined && t_ns <= found.end_ns ? found : undefined;
}

/** In the order of a flight. */
export const kStateNames: Readonly<Record<string, string>> = {
  INITIALISING: 'initialising',
  TRACKING: 'tracking',
  LOST: 'lost',
  CRASHED: 'crashed',
};

export function stateName(state: string): string {
  return kStateNames[state] ?? state.toLowerCase();
}

/** The state of an estimate at a time, in times of the clock. */
export interface TrackState extends StateSpan {
  track: Track;
}

/** Of every shown estimate that has one then. @param t_ns  of the clock */
export function trackStatesAt(
  state: Pick<State, 'watched' | 'colours'>,
  t_ns: number,
): TrackState[] {
  return tracksOf(state).flatMap((track) => {
    const { offset_ns } = track.run;
    const span = track.shown ? spanAt(spansOf(track), t_ns - offset_ns) : undefined;
    if (span === undefined) return [];
    const [begin_ns, end_ns] = [span.begin_ns + offset_ns, span.end_ns + offset_ns];
    return { track, state: span.state, begin_ns, end_ns };
  });
}

/** Of an estimate; none of a truth. */
export function spansOf({ run, name }: Track): readonly StateSpan[] {
  const rows = run.data.estimates.get(name);
  return rows === undefined ? [] : stateSpans(rows, run.data.generation);
}
