// Converts rows to curves with a common time axis and unwrapped angles.
import type { Axis, EstimateRows, RunData } from './run_data';
import { wrapDegrees } from './format';
import { lastAtOrBefore } from './table';

export function isAngle(axis: Axis): boolean {
  return axis.endsWith('_deg');
}

/** The angle equal to `angle_deg` modulo 360 that is nearest to `reference_deg`. */
export function nearestTurn(angle_deg: number, reference_deg: number): number {
  return reference_deg + wrapDegrees(angle_deg - reference_deg);
}

/** One axis of the truth, unwrapped; updated incrementally. */
export class TruthCurve {
  private values = new Float64Array(1024);
  private count = 0;

  constructor(private readonly axis: Axis) {}

  /** @return a view of all rows, valid until the next call */
  update(data: RunData): Float64Array {
    const raw = data.truth.column(this.axis);
    if (!isAngle(this.axis)) return raw;
    if (raw.length > this.values.length) {
      const grown = new Float64Array(Math.max(raw.length, this.values.length * 2));
      grown.set(this.values.subarray(0, this.count));
      this.values = grown;
    }
    for (; this.count < raw.length; this.count += 1) {
      const angle = raw[this.count] ?? NaN;
      const before = this.count > 0 ? (this.values[this.count - 1] ?? angle) : angle;
      this.values[this.count] = nearestTurn(angle, before);
    }
    return this.values.subarray(0, raw.length);
  }
}

/**
 * One axis of an estimate at the truth's rows; null if there is no pose, so that the line breaks.
 */
export class EstimateCurve {
  private readonly values: (number | null)[] = [];
  private taken = 0;

  constructor(private readonly axis: Axis) {}

  update(data: RunData, rows: EstimateRows, truth: Float64Array): readonly (number | null)[] {
    const frames = data.truth.column('frame');
    while (this.values.length < truth.length) this.values.push(null);
    const estimateFrames = rows.table.column('frame');
    const column = rows.table.column(this.axis);
    for (; this.taken < column.length; this.taken += 1) {
      const row = rowOfFrame(frames, estimateFrames[this.taken] ?? NaN);
      if (row >= truth.length) break;
      const value = column[this.taken] ?? NaN;
      if (row < 0 || Number.isNaN(value)) continue;
      this.values[row] = isAngle(this.axis) ? nearestTurn(value, truth[row] ?? value) : value;
    }
    return this.values;
  }
}

/**
 * -1 if there is no row of the frame; the number of rows if the frame is newer than all of them.
 */
function rowOfFrame(frames: Float64Array, frame: number): number {
  if (Number.isNaN(frame)) return -1;
  if (frame > (frames[frames.length - 1] ?? -Infinity)) return frames.length;
  const row = lastAtOrBefore(frames, frame);
  return frames[row] === frame ? row : -1;
}
