// The points of a track that the 3D plot draws: all of a short track; of a long one those that keep
// its shape. A track that grows is continued, so that only its newest points change.
import type { Table } from '../table';
import type { Box3, Point3 } from './axis_box';
import { enclosed } from './axis_box';

/** Numbers of a point: x, y, z [m, east-north-up], time of its run [s], length since a gap [m]. */
export const kPointSize = 5;
/** The time of a point that is not a place: nothing is drawn to it or from it. */
export const kGap_s = -1e9;

/** Poses farther from the origin are those of a diverged estimate: gaps. */
const kFarthest_m = 1e7;
const kFirstCapacity = 1024;

export class DisplayTrack {
  /** A new array each time it is enlarged. */
  points = new Float32Array(kFirstCapacity * kPointSize);
  count = 0;
  /** Encloses all its poses; null without any. */
  box: Box3 | null = null;
  /** Rows whose block is complete, and the points made of them. */
  private settledRows = 0;
  private settledPoints = 0;
  private block = 1;

  constructor(readonly table: Table) {}

  /**
   * Takes the rows that the table has now.
   * @param most  of the points; gaps may add some
   * @return the first point that may have changed
   */
  extend(most: number): number {
    const { table } = this;
    const block = blockFor(table.length, most);
    if (block !== this.block || table.length < this.settledRows) {
      this.block = block;
      this.settledRows = 0;
      this.settledPoints = 0;
      this.box = null;
    }
    const first = this.settledPoints;
    const rows = new Rows(table);
    this.count = first;
    for (let from = this.settledRows; from < table.length; from += block) {
      const end = Math.min(from + block, table.length);
      this.addBlock(rows, from, end);
      if (end - from < block) break;
      this.settledRows = end;
      this.settledPoints = this.count;
    }
    return first;
  }

  /** Adds the parts of a block between its gaps. */
  private addBlock(rows: Rows, from: number, end: number): void {
    let first = from;
    for (let row = from; row < end; row += 1) {
      const place = rows.place(row);
      if (place !== null) {
        this.box = enclosed(this.box, place);
        continue;
      }
      this.addPart(rows, first, row);
      this.addGap();
      first = row + 1;
    }
    this.addPart(rows, first, end);
  }

  /**
   * Adds the last row of a part, and the one farthest from the straight line to it: one step of
   * Douglas and Peucker (Cartographica 10, 1973). After a gap adds the first row as well.
   */
  private addPart(rows: Rows, first: number, end: number): void {
    let begin = first;
    if (begin < end && this.last() === null) this.addRow(rows, begin++);
    if (begin >= end) return;
    const far = this.farthest(rows, begin, end - 1);
    if (far >= 0) this.addRow(rows, far);
    this.addRow(rows, end - 1);
  }

  /** The row in [first, end) farthest from the line of the last point and row `end`; -1 if none. */
  private farthest(rows: Rows, first: number, end: number): number {
    const { x, y, z } = rows;
    const [x0 = NaN, y0 = NaN, z0 = NaN] = this.last()?.place ?? [];
    const [dx, dy, dz] = [(x[end] ?? NaN) - x0, (y[end] ?? NaN) - y0, (z[end] ?? NaN) - z0];
    const length2 = dx * dx + dy * dy + dz * dz;
    let found = -1;
    let most = -1;
    for (let row = first; row < end; row += 1) {
      const [px, py, pz] = [(x[row] ?? NaN) - x0, (y[row] ?? NaN) - y0, (z[row] ?? NaN) - z0];
      const along = px * dx + py * dy + pz * dz;
      const off2 = px * px + py * py + pz * pz - (length2 > 0 ? (along * along) / length2 : 0);
      if (off2 <= most) continue;
      most = off2;
      found = row;
    }
    return found;
  }

  /** The last point; null at a gap and at the beginning. */
  private last(): { place: Point3; length_m: number } | null {
    if (this.count === 0) return null;
    const at = (this.count - 1) * kPointSize;
    const [x = 0, y = 0, z = 0, t_s, length_m = 0] = this.points.subarray(at, at + kPointSize);
    return t_s === kGap_s ? null : { place: [x, y, z], length_m };
  }

  private addGap(): void {
    const last = this.last();
    if (last !== null) this.add(last.place, kGap_s, 0);
  }

  private addRow(rows: Rows, row: number): void {
    const place = rows.place(row);
    if (place === null) return;
    const last = this.last();
    const [x, y, z] = place;
    const [x0, y0, z0] = last?.place ?? place;
    this.add(place, rows.t_s(row), (last?.length_m ?? 0) + Math.hypot(x - x0, y - y0, z - z0));
  }

  private add([x, y, z]: Point3, t_s: number, length_m: number): void {
    const at = this.count * kPointSize;
    if (at === this.points.length) {
      const enlarged = new Float32Array(this.points.length * 2);
      enlarged.set(this.points);
      this.points = enlarged;
    }
    this.points.set([x, y, z, t_s, length_m], at);
    this.count += 1;
  }
}

/** The poses of a table, valid until its next write. */
class Rows {
  readonly x: Float64Array;
  readonly y: Float64Array;
  readonly z: Float64Array;
  private readonly t_ns: Float64Array;

  constructor(table: Table) {
    this.x = table.column('x_m');
    this.y = table.column('y_m');
    this.z = table.column('z_m');
    this.t_ns = table.column('t_ns');
  }

  /** null if there is no pose. */
  place(row: number): Point3 | null {
    const [x, y, z] = [this.x[row] ?? NaN, this.y[row] ?? NaN, this.z[row] ?? NaN];
    const far_m = Math.max(Math.abs(x), Math.abs(y), Math.abs(z));
    return far_m <= kFarthest_m && Number.isFinite(this.t_ns[row]) ? [x, y, z] : null;
  }

  t_s(row: number): number {
    return (this.t_ns[row] ?? NaN) / 1e9;
  }
}

/** Rows of which two points remain; 1 = every row is a point. */
function blockFor(rows: number, most: number): number {
  if (rows <= most) return 1;
  let block = 4;
  while ((2 * rows) / block > most) block *= 2;
  return block;
}
