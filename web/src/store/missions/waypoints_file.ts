// Missions as text (.waypoints, QGC WPL 110): a line for each item, home first.
import type { Mission, MissionItem, SimpleItem } from './mission_item';
import type { NewId } from './plan_file';
import { countAt, emptyMission, expandedItems, MissionFileError } from './plan_file';

const kHead = 'QGC WPL 110';
const kColumns = 12;
const kMostItems = 5000;

/** Errors: MissionFileError naming line, column and limit. */
export function readWaypoints(text: string, newId: NewId): Mission {
  const lines = text.split(/\r?\n/);
  if (lines[0]?.trim().replace(/\s+/g, ' ') !== kHead) {
    throw new MissionFileError(`line 1: must be "${kHead}"`);
  }
  const rows = lines.flatMap((line, i) =>
    i === 0 || line.trim() === '' || line.trim().startsWith('#')
      ? []
      : [{ line: i + 1, fields: line.trim().split(/\s+/) }],
  );
  if (rows.length === 0 || rows.length > kMostItems) {
    throw new MissionFileError(`${rows.length} items: must be in [1, ${kMostItems}]`);
  }
  const items = rows.map((row, i) => itemOf(row, i));
  const [home, ...rest] = items;
  const [, , , , lat_deg, lon_deg, alt_msl_m] = home?.params ?? [];
  const mission = emptyMission({
    lat_deg: lat_deg ?? 0,
    lon_deg: lon_deg ?? 0,
    alt_msl_m: alt_msl_m ?? 0,
  });
  return { ...mission, items: rest.map((item) => ({ id: newId(), ...item })) };
}

export interface WaypointsText {
  text: string;
  /** What the format cannot hold, for people. */
  lost: string[];
}

export function writeWaypoints(mission: Mission): WaypointsText {
  const { home, rest } = mission;
  const lost: string[] = [];
  const rows: string[] = [
    row(0, true, 0, 16, [0, 0, 0, 0, home.lat_deg, home.lon_deg, home.alt_msl_m], true),
  ];
  const add = ({ frame, command, params, autoContinue }: SimpleItem) => {
    rows.push(row(rows.length, false, frame, command, params, autoContinue));
  };
  for (const item of mission.items) {
    if (item.kind === 'simple') add(item);
    else writeComplex(item, add, lost);
  }
  const areas = countAt(rest, 'geoFence', 'polygons', 'circles');
  if (areas > 0) lost.push(`the geofence (${areas})`);
  const rally = countAt(rest, 'rallyPoints', 'points');
  if (rally > 0) lost.push(`the rally points (${rally})`);
  return { text: `${kHead}\n${rows.join('\n')}\n`, lost };
}

function writeComplex(
  item: Extract<MissionItem, { kind: 'complex' }>,
  add: (item: SimpleItem) => void,
  lost: string[],
): void {
  const items = expandedItems(item.raw);
  items.forEach(add);
  lost.push(
    items.length === 0
      ? `the item "${item.type}"`
      : `that ${items.length} waypoints belong to the item "${item.type}"`,
  );
}

function itemOf({ line, fields }: { line: number; fields: string[] }, index: number): SimpleItem {
  if (fields.length !== kColumns) {
    throw new MissionFileError(`line ${line}: ${fields.length} columns: must be ${kColumns}`);
  }
  const values = fields.map((field, column) => {
    // A ground station writes "nan" where the vehicle has to choose.
    if (/^-?nan$/i.test(field) && column >= 4 && column < 8) return null;
    const value = Number(field);
    if (!Number.isFinite(value)) {
      throw new MissionFileError(`line ${line}, column ${column + 1} = ${field}: must be a number`);
    }
    return value;
  });
  if (values[0] !== index) {
    throw new MissionFileError(`line ${line}, column 1 = ${fields[0] ?? ''}: must be ${index}`);
  }
  const [, , frame, command] = values;
  const [lat, lon] = [values[8] ?? 0, values[9] ?? 0];
  if (frame !== 2 && (Math.abs(lat) > 90 || Math.abs(lon) > 180)) {
    throw new MissionFileError(`line ${line}: ${lat}, ${lon}: is no place on the earth`);
  }
  return {
    kind: 'simple',
    command: command ?? 0,
    frame: frame ?? 0,
    params: values.slice(4, 11),
    autoContinue: values[11] !== 0,
    extra: {},
  };
}

function row(
  index: number,
  current: boolean,
  frame: number,
  command: number,
  params: readonly (number | null)[],
  autoContinue: boolean,
): string {
  const texts = params.map((value, i) => {
    // The format has no word for "the vehicle's default" that every station reads: 0 is that.
    const number = value ?? 0;
    return i === 4 || i === 5 ? number.toFixed(8) : plain(number);
  });
  return [index, current ? 1 : 0, frame, command, ...texts, autoContinue ? 1 : 0].join('\t');
}

/** A decimal without an exponent; exact to 1e-6. */
function plain(value: number): string {
  return value.toFixed(6).replace(/\.?0+$/, '');
}
