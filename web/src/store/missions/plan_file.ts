// Plans of QGroundControl (.plan) as missions, and back. What is not edited here is kept as it is.
import type { Json, JsonObject } from '../../protocol/rest_types';
import type { Home, Mission, MissionItem, Params, SimpleItem } from './mission_item';
import { isFlown, itemTitle, numbersOf } from './mission_item';

const kMostItems = 5000;
const kLandingItems = 3;

/** Numbers that tell items apart while they are edited. */
export type NewId = () => number;

export class MissionFileError extends Error {}

export function emptyMission(home: Home): Mission {
  return { home, items: [], rest: emptyPlan() };
}

function emptyPlan(): JsonObject {
  return {
    fileType: 'Plan',
    geoFence: { circles: [], polygons: [], version: 2 },
    groundStation: 'Overfly',
    mission: {
      cruiseSpeed: 25,
      firmwareType: 3,
      globalPlanAltitudeMode: 1,
      hoverSpeed: 5,
      vehicleType: 1,
      version: 2,
    },
    rallyPoints: { points: [], version: 2 },
    version: 1,
  };
}

/** Errors: MissionFileError naming field and limit. */
export function missionFromPlan(plan: Json, newId: NewId): Mission {
  if (!isObject(plan) || plan['fileType'] !== 'Plan') {
    throw new MissionFileError('fileType: must be "Plan": this is no plan of QGroundControl');
  }
  const mission = plan['mission'];
  if (!isObject(mission)) throw new MissionFileError('mission: must be an object');
  if (mission['version'] !== 2) {
    throw new MissionFileError(
      `mission.version = ${JSON.stringify(mission['version'] ?? null)}: must be 2`,
    );
  }
  const { items, plannedHomePosition, ...settings } = mission;
  if (!Array.isArray(items)) throw new MissionFileError('mission.items: must be an array');
  if (items.length > kMostItems) {
    throw new MissionFileError(
      `mission.items = ${items.length} items: must be at most ${kMostItems}`,
    );
  }
  return {
    home: homeFrom(plannedHomePosition),
    items: items.map((item, i) => itemFrom(item, `mission.items.${i}`, newId())),
    rest: { ...plan, mission: settings },
  };
}

/** Errors: MissionFileError naming line and column, or as missionFromPlan. */
export function readPlanText(text: string, newId: NewId): Mission {
  let plan: Json;
  try {
    plan = JSON.parse(text) as Json;
  } catch (error) {
    throw new MissionFileError(`is no JSON: ${(error as Error).message}`);
  }
  return missionFromPlan(plan, newId);
}

export function planFromMission(mission: Mission): JsonObject {
  const { home, items, rest } = mission;
  const settings = isObject(rest['mission']) ? rest['mission'] : {};
  const numbers = numbersOf(mission);
  return {
    ...rest,
    mission: {
      ...settings,
      items: items.map((item, i) => planItem(item, numbers[i] ?? 0)),
      plannedHomePosition: [home.lat_deg, home.lon_deg, home.alt_msl_m],
    },
  };
}

export function planText(mission: Mission): string {
  return `${JSON.stringify(planFromMission(mission), null, 4)}\n`;
}

/** What of a mission the built-in aircraft does not fly, for people. */
export function notFlown(mission: Mission): string[] {
  const notes: string[] = [];
  const numbers = numbersOf(mission);
  mission.items.forEach((item, i) => {
    if (item.kind === 'complex') {
      if (item.count === 0) {
        notes.push(`Item ${numbers[i] ?? 0}: ${itemTitle(item)} has no stored items`);
      }
    } else if (!isFlown(item.command)) {
      notes.push(`Item ${numbers[i] ?? 0}: command ${item.command} is kept, but not flown`);
    }
  });
  const areas = countAt(mission.rest, 'geoFence', 'polygons', 'circles');
  if (areas > 0) notes.push(`The geofence (${areas}) is kept, but not observed`);
  const rally = countAt(mission.rest, 'rallyPoints', 'points');
  if (rally > 0) notes.push(`The rally points (${rally}) are kept, but not used`);
  return notes;
}

/** Entries of lists in a part of the plan. */
export function countAt(rest: JsonObject, part: string, ...lists: string[]): number {
  const outer = rest[part];
  if (!isObject(outer)) return 0;
  return lists.reduce((sum, name) => {
    const list = outer[name];
    return sum + (Array.isArray(list) ? list.length : 0);
  }, 0);
}

/** The items that a complex item is flown as. */
export function expandedItems(raw: JsonObject): SimpleItem[] {
  const transect = raw['TransectStyleComplexItem'];
  const items = isObject(transect) ? transect['Items'] : undefined;
  if (!Array.isArray(items)) return [];
  return items.flatMap((item) => (isObject(item) ? [simpleFrom(item, 'item')] : []));
}

function homeFrom(value: Json | undefined): Home {
  if (!Array.isArray(value) || value.length !== 3 || !value.every(isNumber)) {
    throw new MissionFileError(
      'mission.plannedHomePosition: must be an array of latitude, longitude and height',
    );
  }
  const [lat_deg = 0, lon_deg = 0, alt_msl_m = 0] = value;
  checkPlace(lat_deg, lon_deg, 'mission.plannedHomePosition');
  return { lat_deg, lon_deg, alt_msl_m };
}

function itemFrom(item: Json, path: string, id: number): MissionItem {
  if (!isObject(item)) throw new MissionFileError(`${path}: must be an object`);
  if (item['type'] === 'SimpleItem') return { id, ...simpleFrom(item, path) };
  if (item['type'] !== 'ComplexItem') {
    throw new MissionFileError(`${path}.type: must be "SimpleItem" or "ComplexItem"`);
  }
  const type = typeof item['complexItemType'] === 'string' ? item['complexItemType'] : 'complex';
  const count = type === 'fwLandingPattern' ? kLandingItems : expandedItems(item).length;
  return { id, kind: 'complex', type, raw: item, count };
}

function simpleFrom(item: JsonObject, path: string): SimpleItem {
  const { type: _type, command, frame, params, autoContinue, ...extra } = item;
  // Items are counted again when they are written.
  delete extra['doJumpId'];
  void _type;
  if (!isNumber(command) || !isNumber(frame)) {
    throw new MissionFileError(`${path}: must have a command and a frame`);
  }
  if (
    !Array.isArray(params) ||
    params.length !== 7 ||
    !params.every((value) => value === null || isNumber(value))
  ) {
    throw new MissionFileError(`${path}.params: must be 7 numbers or null`);
  }
  const numbers: Params = params;
  if (frame !== 2) checkPlace(numbers[4] ?? 0, numbers[5] ?? 0, `${path}.params`);
  return {
    kind: 'simple',
    command,
    frame,
    params: numbers,
    autoContinue: autoContinue !== false,
    extra,
  };
}

function checkPlace(lat_deg: number, lon_deg: number, path: string): void {
  if (Math.abs(lat_deg) <= 90 && Math.abs(lon_deg) <= 180) return;
  throw new MissionFileError(`${path} = ${lat_deg}, ${lon_deg}: is no place on the earth`);
}

/** QGroundControl shows the height of `Altitude`, and counts items by `doJumpId`. */
function planItem(item: MissionItem, number: number): JsonObject {
  if (item.kind === 'complex') return item.raw;
  const { command, frame, params, autoContinue, extra } = item;
  const shown: JsonObject = 'Altitude' in extra ? { Altitude: params[6] ?? 0 } : {};
  return {
    ...extra,
    ...shown,
    autoContinue,
    command,
    doJumpId: number,
    frame,
    params: [...params],
    type: 'SimpleItem',
  };
}

function isNumber(value: Json | undefined): value is number {
  return typeof value === 'number' && Number.isFinite(value);
}

export function isObject(value: Json | undefined): value is JsonObject {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}
