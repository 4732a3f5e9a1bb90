// Edits of a mission: each returns a new one and leaves the old one as it was.
import { metresPerDegree } from '../metres_per_degree';
import { movedRaw } from './complex_item';
import type { Home, Mission, MissionItem, SimpleItem } from './mission_item';
import {
  hasHeight,
  isCircle,
  kCommand,
  kFrame,
  placeOf,
  radiusIndex,
  withParam,
} from './mission_item';

const kUsualHeight_m = 300;
const kTakeOffHeight_m = 60;
const kUsualRadius_m = 120;
/** 1e-8 deg is 1 mm. */
const kDegreeStep = 1e8;

export function roundDegrees(value_deg: number): number {
  return Math.round(value_deg * kDegreeStep) / kDegreeStep;
}

/** A new item of a command at a place, with the heights of the items before it. */
export function newItem(
  mission: Mission,
  index: number,
  id: number,
  command: number,
  place: readonly [number, number],
): MissionItem {
  const before = mission.items.slice(0, index).filter(hasHeight).at(-1);
  const takesOff = command === kCommand.takeOff;
  const lands = command === kCommand.land;
  let frame: number = before?.frame ?? kFrame.aboveGround;
  let height_m = before?.params[6] ?? kUsualHeight_m;
  if (takesOff || lands) {
    frame = kFrame.aboveHome;
    height_m = takesOff ? kTakeOffHeight_m : 0;
  } else if (before?.command === kCommand.takeOff) {
    frame = kFrame.aboveGround;
    height_m = kUsualHeight_m;
  }
  const placed = command !== kCommand.speed && command !== kCommand.home;
  const params: (number | null)[] = [
    0,
    0,
    0,
    placed ? null : 0,
    placed ? roundDegrees(place[0]) : 0,
    placed ? roundDegrees(place[1]) : 0,
    placed ? height_m : 0,
  ];
  if (takesOff) params[0] = 15;
  if (command === kCommand.circleTurns) params[0] = 1;
  if (command === kCommand.circleTime) params[0] = 60;
  if (isCircle(command)) params[radiusIndex(command)] = kUsualRadius_m;
  if (command === kCommand.speed) params.splice(0, 3, 0, 20, -1);
  return {
    id,
    kind: 'simple',
    command,
    frame: placed ? frame : kFrame.command,
    params,
    autoContinue: true,
    extra: {},
  };
}

export function inserted(mission: Mission, index: number, item: MissionItem): Mission {
  const items = [...mission.items.slice(0, index), item, ...mission.items.slice(index)];
  return { ...mission, items };
}

export function removed(mission: Mission, id: number): Mission {
  return { ...mission, items: mission.items.filter((item) => item.id !== id) };
}

/** Moves an item in the order by `step`; the ends are ends. */
export function reordered(mission: Mission, id: number, step: number): Mission {
  const from = mission.items.findIndex((item) => item.id === id);
  const item = mission.items[from];
  const to = Math.max(0, Math.min(mission.items.length - 1, from + step));
  if (item === undefined || to === from) return mission;
  return inserted(removed(mission, id), to, item);
}

export function changed(
  mission: Mission,
  id: number,
  change: (item: SimpleItem) => SimpleItem,
): Mission {
  return {
    ...mission,
    items: mission.items.map((item) =>
      item.id === id && item.kind === 'simple' ? { ...change(item), id } : item,
    ),
  };
}

export function placed(mission: Mission, id: number, place: readonly [number, number]): Mission {
  return changed(mission, id, (item) =>
    withParam(withParam(item, 4, roundDegrees(place[0])), 5, roundDegrees(place[1])),
  );
}

/** Moves an item by metres. */
export function nudged(mission: Mission, id: number, east_m: number, north_m: number): Mission {
  const item = mission.items.find((one) => one.id === id);
  const place = item === undefined ? null : placeOf(item);
  if (place === null) return mission;
  const scale = metresPerDegree(place[0]);
  return placed(mission, id, [place[0] + north_m / scale.north, place[1] + east_m / scale.east]);
}

export function withHome(mission: Mission, home: Home): Mission {
  return { ...mission, home };
}

/** Moves everything so that home lies at a place; heights stay. */
export function movedTo(mission: Mission, place: readonly [number, number]): Mission {
  const from = metresPerDegree(mission.home.lat_deg);
  const to = metresPerDegree(place[0]);
  const north_deg = place[0] - mission.home.lat_deg;
  // Distances in metres stay, also at another latitude.
  const move = (lat_deg: number, lon_deg: number): [number, number] => [
    roundDegrees(lat_deg + north_deg),
    roundDegrees(place[1] + ((lon_deg - mission.home.lon_deg) * from.east) / to.east),
  ];
  const items = mission.items.map((item): MissionItem => {
    if (item.kind === 'complex') return { ...item, raw: movedRaw(item.raw, move) };
    const at = placeOf(item);
    if (at === null) return item;
    const [lat_deg, lon_deg] = move(...at);
    return { ...withParam(withParam(item, 4, lat_deg), 5, lon_deg), id: item.id };
  });
  return {
    ...mission,
    home: { ...mission.home, lat_deg: roundDegrees(place[0]), lon_deg: roundDegrees(place[1]) },
    items,
  };
}

/** Changes what an item is; its place and height stay. */
export function withCommand(mission: Mission, id: number, command: number): Mission {
  const index = mission.items.findIndex((item) => item.id === id);
  const old = mission.items[index];
  if (old === undefined || old.kind !== 'simple' || old.command === command) return mission;
  const place = placeOf(old) ?? [mission.home.lat_deg, mission.home.lon_deg];
  const made = newItem(mission, index, id, command, place);
  if (made.kind !== 'simple') return mission;
  const item = hasHeight({ ...old, id }) && hasHeight(made) ? keptHeight(made, old) : made;
  const items = mission.items.map((kept, i) => (i === index ? { ...item, id } : kept));
  return { ...mission, items };
}

function keptHeight(made: SimpleItem, old: SimpleItem): SimpleItem {
  if (made.command === kCommand.land || made.command === kCommand.takeOff) return made;
  return { ...withParam(made, 6, old.params[6] ?? 0), frame: old.frame };
}

/** Heights of an item, as the server flies them. */
export interface ItemHeights {
  above_ground_m: number;
  above_home_m: number;
}

/**
 * Counts an item's height from elsewhere; the item stays where it is if the heights are known, else
 * the number stays.
 */
export function withFrame(
  mission: Mission,
  id: number,
  frame: number,
  heights: ItemHeights | null,
): Mission {
  return changed(mission, id, (item) => {
    if (item.frame === frame) return item;
    const height_m = heights === null ? item.params[6] : heightIn(frame, mission, heights);
    const rounded = Math.round((height_m ?? 0) * 10) / 10;
    return { ...withParam(item, 6, rounded), frame };
  });
}

function heightIn(frame: number, { home }: Mission, heights: ItemHeights): number {
  if (frame === kFrame.aboveGround) return heights.above_ground_m;
  // The server keeps heights above sea level as differences from home's.
  const base_m = frame === kFrame.seaLevel ? home.alt_msl_m : 0;
  return heights.above_home_m + base_m;
}

/** Index at which a new item follows another one; at the end without one. */
export function indexAfter(mission: Mission, id: number | null): number {
  const index = mission.items.findIndex((item) => item.id === id);
  return index < 0 ? mission.items.length : index + 1;
}

/** The item next to another one; the first or last one if there is none. */
export function neighbour(mission: Mission, id: number | null, step: number): number | null {
  const { items } = mission;
  if (items.length === 0) return null;
  const index = items.findIndex((item) => item.id === id);
  const next = index < 0 ? (step > 0 ? 0 : items.length - 1) : index + step;
  return items[Math.max(0, Math.min(items.length - 1, next))]?.id ?? null;
}
