// Rows of a data stream, column by column, in typed arrays that grow.
import type { Cell } from '../protocol/messages';

const kFirstCapacity = 1024;

/** Numbers; absent or null values are NaN. */
class NumberColumn {
  private values = new Float64Array(kFirstCapacity);
  private count = 0;

  /** A view, valid until the next write. */
  view(): Float64Array {
    return this.values.subarray(0, this.count);
  }

  at(row: number): number {
    return row < this.count ? (this.values[row] ?? NaN) : NaN;
  }

  /** Writes `rows` cells from row `first` on, and discards all old rows from there. */
  write(first: number, rows: number, cells: readonly Cell[] | undefined): void {
    const end = first + rows;
    if (end > this.values.length) {
      const grown = new Float64Array(Math.max(end, this.values.length * 2));
      grown.set(this.values.subarray(0, this.count));
      this.values = grown;
    }
    if (first > this.count) this.values.fill(NaN, this.count, first);
    for (let i = 0; i < rows; i += 1) {
      const cell = cells?.[i];
      this.values[first + i] = typeof cell === 'number' ? cell : NaN;
    }
    this.count = end;
  }
}

/** The columns of numbers that the server has sent. A column that was never sent is NaN. */
export class Table {
  private readonly columns = new Map<string, NumberColumn>();
  private count = 0;

  get length(): number {
    return this.count;
  }

  /** A view, valid until the next write. */
  column(name: string): Float64Array {
    return this.columns.get(name)?.view() ?? new Float64Array(this.count).fill(NaN);
  }

  /** Whether a column of numbers was sent. */
  has(name: string): boolean {
    return this.columns.has(name);
  }

  at(name: string, row: number): number {
    return this.columns.get(name)?.at(row) ?? NaN;
  }

  /** The value in the last row; NaN without rows. */
  last(name: string): number {
    return this.at(name, this.count - 1);
  }

  /** Writes rows from `first` on, and discards all old rows from there. */
  write(first: number, rows: number, columns: Record<string, Cell[]>): void {
    for (const [name, cells] of Object.entries(columns)) {
      if (!this.columns.has(name) && cells.some((cell) => typeof cell === 'number')) {
        this.columns.set(name, new NumberColumn());
      }
    }
    for (const [name, column] of this.columns) column.write(first, rows, columns[name]);
    this.count = first + rows;
  }
}

/** Index of the last value <= x of an ascending array; -1 if there is none. */
export function lastAtOrBefore(ascending: ArrayLike<number>, x: number): number {
  let low = 0;
  let high = ascending.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((ascending[middle] ?? Infinity) <= x) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** Index of the value nearest to x of an ascending array; -1 if it is empty. */
export function nearestIndex(ascending: ArrayLike<number>, x: number): number {
  if (ascending.length === 0) return -1;
  const before = lastAtOrBefore(ascending, x);
  if (before < 0) return 0;
  if (before === ascending.length - 1) return before;
  const left = x - (ascending[before] ?? 0);
  const right = (ascending[before + 1] ?? 0) - x;
  return left <= right ? before : before + 1;
}
