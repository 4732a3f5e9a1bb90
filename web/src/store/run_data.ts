// All rows received of a watched run.
import type { Cell, Resume, Rows } from '../protocol/messages';
import { Table } from './table';
import type { VehicleRow } from './vehicle/vehicle_status';
import { vehicleRows } from './vehicle/vehicle_status';

export const kAxes = ['x_m', 'y_m', 'z_m', 'roll_deg', 'pitch_deg', 'yaw_deg'] as const;
export type Axis = (typeof kAxes)[number];

export interface LogLine {
  t_ns: number;
  level: string;
  text: string;
  /** 'fault'; 'mode', 'mission' or 'event' of the flight; else empty. */
  kind: string;
  /** The estimator that logged it; empty = the range. */
  source: string;
}

export interface EstimateRows {
  /** The six axes, errors, latency and counters of docs/PROTOCOL.md. */
  table: Table;
  states: string[];
}

const kEstimatePrefix = 'estimate/';

export class RunData {
  /** Poses of the frames and quantities of their images (docs/PROTOCOL.md). */
  readonly truth = new Table();
  /** Faults of the scenario active at each frame. */
  readonly faults: (readonly string[])[] = [];
  readonly estimates = new Map<string, EstimateRows>();
  readonly log: LogLine[] = [];
  /** Of a live vehicle; empty for other flights. */
  readonly vehicle: VehicleRow[] = [];
  /** Its numbers, to be plotted. */
  readonly vehicleTable = new Table();
  /** Increases when rows are replaced, which invalidates values computed from them. */
  generation = 0;

  /**
   * Adds rows. If rows are sent again, the server's version replaces the stored one.
   * @return false if preceding rows are missing; nothing is changed then
   */
  apply(rows: Omit<Rows, 'run'>): boolean {
    const count = Math.max(0, ...Object.values(rows.columns).map((cells) => cells.length));
    const known = this.countOf(rows.stream);
    if (rows.seq > known) return false;
    if (rows.seq < known) this.generation += 1;
    if (rows.stream === 'truth') {
      this.truth.write(rows.seq, count, rows.columns);
      this.faults.splice(rows.seq, Infinity, ...faultLists(rows.columns['faults'], count));
    } else if (rows.stream === 'log') {
      this.log.splice(rows.seq, Infinity, ...logLines(rows.columns, count));
    } else if (rows.stream === 'vehicle') {
      this.vehicle.splice(rows.seq, Infinity, ...vehicleRows(rows.columns, count));
      this.vehicleTable.write(rows.seq, count, rows.columns);
    } else if (rows.stream.startsWith(kEstimatePrefix)) {
      const estimate = this.estimate(rows.stream.slice(kEstimatePrefix.length));
      estimate.table.write(rows.seq, count, rows.columns);
      const states = (rows.columns['state'] ?? []).map(String);
      estimate.states.splice(rows.seq, Infinity, ...states);
    }
    return true;
  }

  /** Number of rows received by stream, in the form of `watch`. */
  resume(): Resume {
    const counts: Resume = {};
    if (this.truth.length > 0) counts['truth'] = this.truth.length;
    if (this.log.length > 0) counts['log'] = this.log.length;
    if (this.vehicle.length > 0) counts['vehicle'] = this.vehicle.length;
    for (const [name, { table }] of this.estimates) {
      if (table.length > 0) counts[kEstimatePrefix + name] = table.length;
    }
    return counts;
  }

  private countOf(stream: string): number {
    if (stream === 'truth') return this.truth.length;
    if (stream === 'log') return this.log.length;
    if (stream === 'vehicle') return this.vehicle.length;
    return this.estimates.get(stream.slice(kEstimatePrefix.length))?.table.length ?? 0;
  }

  private estimate(name: string): EstimateRows {
    let rows = this.estimates.get(name);
    if (rows === undefined) {
      rows = estimateRows({});
      this.estimates.set(name, rows);
    }
    return rows;
  }
}

/** Rows of an estimate from their columns. */
export function estimateRows(columns: Record<string, Cell[]>): EstimateRows {
  const rows: EstimateRows = {
    table: new Table(),
    states: (columns['state'] ?? []).map(String),
  };
  rows.table.write(0, columns['frame']?.length ?? 0, columns);
  return rows;
}

const kNoFaults: readonly string[] = [];

function faultLists(cells: readonly Cell[] | undefined, count: number): (readonly string[])[] {
  return Array.from({ length: count }, (_, i) => {
    const cell = cells?.[i];
    return Array.isArray(cell) ? cell : kNoFaults;
  });
}

function logLines(columns: Record<string, Cell[]>, count: number): LogLine[] {
  return Array.from({ length: count }, (_, i) => ({
    t_ns: Number(columns['t_ns']?.[i] ?? 0),
    level: String(columns['level']?.[i] ?? 'info'),
    text: String(columns['text']?.[i] ?? ''),
    kind: String(columns['kind']?.[i] ?? ''),
    source: String(columns['source']?.[i] ?? ''),
  }));
}
