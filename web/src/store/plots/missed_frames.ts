// Frames of a flight without an answer of an estimator: dropped while it was busy, answered too late,
// lost on the way, or never given. Their rows are missing among its answers.
import { lastAtOrBefore } from '../table';
import type { Table } from '../table';

export interface MissedFrames {
  /** Of the frames from the first one to the last answered one. */
  t_ns: Float64Array;
  /** Missed so far. */
  count: Float64Array;
}

/**
 * @param whole  the flight is over: frames after the last answer are missed as well; before that they may
 *   still be answered
 */
export function missedFrames(truth: Table, answers: Table, whole: boolean): MissedFrames {
  const frames = truth.column('frame');
  const answered = answers.column('frame');
  const last = answered.at(-1) ?? -1;
  const rows = whole ? frames.length : lastAtOrBefore(frames, last) + 1;
  const count = new Float64Array(rows);
  let next = 0;
  let missed = 0;
  for (let row = 0; row < rows; row += 1) {
    while ((answered[next] ?? Infinity) < (frames[row] ?? NaN)) next += 1;
    if (answered[next] !== frames[row]) missed += 1;
    count[row] = missed;
  }
  return { t_ns: truth.column('t_ns').subarray(0, rows), count };
}

interface Known {
  key: string;
  found: MissedFrames;
}

const known = new WeakMap<Table, Known>();

/** As `missedFrames`, counted again only when there are more rows. */
export function knownMissedFrames(
  truth: Table,
  answers: Table,
  whole: boolean,
  generation: number,
): MissedFrames {
  const key = [truth.length, answers.length, whole, generation].join(' ');
  const have = known.get(answers);
  if (have?.key === key) return have.found;
  const found = missedFrames(truth, answers, whole);
  known.set(answers, { key, found });
  return found;
}
