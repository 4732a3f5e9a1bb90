// Rows of a data stream, column by column, in typed arrays that grow.
import type { Cell } from '../protocol/messages';

const kFirstCapacity = 1024;

/** Numbers; absent or null values are NaN. */
export class NumberColumn {
  private values = new Float64Array(kFirstCapacity);
  private count = 0;

  get length(): number {
    return this.count;
  }

  /** A view, valid until the next write. */
  view(): Float64Array {
    return this.values.subarray(0, this.count);
  }

  at(row: number): number {
    return row < this.count ? (this.values[row] ?? NaN) : NaN;
  }

  /** Writes `cells` from row `first` on, and discards all old rows from there. */
  write(first: number, cells: readonly Cell[]): void {
    const end = first + cells.length;
    if (end > this.values.length) {
      const grown = new Float64Array(Math.max(end, this.values.length * 2));
      grown.set(this.values.subarray(0, this.count));
      this.values = grown;
    }
    for (let i = 0; i < cells.length; i += 1) {
      const cell = cells[i];
      this.values[first + i] = typeof cell === 'number' ? cell : NaN;
    }
    this.count = end;
  }
}

export class Table<Name extends string> {
  private readonly columns: Record<Name, NumberColumn>;
  private count = 0;

  constructor(private readonly names: readonly Name[]) {
    this.columns = Object.fromEntries(names.map((name) => [name, new NumberColumn()])) as Record<
      Name,
      NumberColumn
    >;
  }

  get length(): number {
    return this.count;
  }

  column(name: Name): Float64Array {
    return this.columns[name].view();
  }

  at(name: Name, row: number): number {
    return this.columns[name].at(row);
  }

  write(first: number, rows: number, columns: Record<string, Cell[]>): void {
    for (const name of this.names) {
      const cells = columns[name] ?? new Array<Cell>(rows).fill(null);
      this.columns[name].write(first, cells);
    }
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
