// The items of a mission as they are edited: MAVLink commands with a place and parameters.
import type { JsonObject } from '../../protocol/rest_types';

/** MAV_CMD. */
export const kCommand = {
  waypoint: 16,
  circle: 17,
  circleTurns: 18,
  circleTime: 19,
  home: 20,
  land: 21,
  takeOff: 22,
  circleToHeight: 31,
  speed: 178,
} as const;

/** MAV_FRAME. */
export const kFrame = { seaLevel: 0, command: 2, aboveHome: 3, aboveGround: 10 } as const;

/** Four parameters, latitude, longitude, height; null = the vehicle's default. */
export type Params = readonly (number | null)[];

export interface SimpleItem {
  kind: 'simple';
  command: number;
  frame: number;
  params: Params;
  autoContinue: boolean;
  /** Fields of the plan that are kept as they are. */
  extra: JsonObject;
}

/** A survey, a corridor, a landing pattern: kept as it is, moved and deleted as a whole. */
export interface ComplexItem {
  kind: 'complex';
  /** Its name in the plan: "survey". */
  type: string;
  raw: JsonObject;
  /** Number of mission items that it is flown as. */
  count: number;
}

export type MissionItem = { id: number } & (SimpleItem | ComplexItem);

export interface Home {
  lat_deg: number;
  lon_deg: number;
  alt_msl_m: number;
}

/** A mission; every edit makes a new one. */
export interface Mission {
  home: Home;
  items: readonly MissionItem[];
  /** What else the plan contains: fence, rally points, settings of the ground station. */
  rest: JsonObject;
}

interface CommandInfo {
  title: string;
  /** It has a place on the map. */
  placed: boolean;
  /** It has a height. */
  high: boolean;
}

const kCommands: ReadonlyMap<number, CommandInfo> = new Map([
  [kCommand.takeOff, { title: 'Take-off', placed: true, high: true }],
  [kCommand.waypoint, { title: 'Waypoint', placed: true, high: true }],
  [kCommand.circleTurns, { title: 'Circle, turns', placed: true, high: true }],
  [kCommand.circleTime, { title: 'Circle, time', placed: true, high: true }],
  [kCommand.circleToHeight, { title: 'Circle to height', placed: true, high: true }],
  [kCommand.circle, { title: 'Circle, endless', placed: true, high: true }],
  [kCommand.speed, { title: 'Airspeed', placed: false, high: false }],
  [kCommand.home, { title: 'Return home', placed: false, high: false }],
  [kCommand.land, { title: 'Landing', placed: true, high: true }],
]);

/** In the order in which they are offered. */
export const kKnownCommands: readonly number[] = [...kCommands.keys()];

export function commandTitle(command: number): string {
  return kCommands.get(command)?.title ?? `Command ${command}`;
}

export function itemTitle(item: MissionItem): string {
  if (item.kind === 'complex') return kComplexTitles[item.type] ?? item.type;
  return commandTitle(item.command);
}

const kComplexTitles: Readonly<Record<string, string>> = {
  survey: 'Survey',
  CorridorScan: 'Corridor',
  fwLandingPattern: 'Landing pattern',
};

/** Whether the built-in aircraft flies it; other DO_ commands are left out, others refused. */
export function isFlown(command: number): boolean {
  return kCommands.has(command);
}

export function isCircle(command: number): boolean {
  return (
    command === kCommand.circle ||
    command === kCommand.circleTurns ||
    command === kCommand.circleTime ||
    command === kCommand.circleToHeight
  );
}

export function hasHeight(item: MissionItem): item is MissionItem & SimpleItem {
  return item.kind === 'simple' && (kCommands.get(item.command)?.high ?? false);
}

/** Latitude and longitude; null for an item without a place of its own. */
export function placeOf(item: MissionItem): [number, number] | null {
  if (item.kind !== 'simple') return null;
  const known = kCommands.get(item.command);
  if (known !== undefined && !known.placed) return null;
  if (known === undefined && item.frame === kFrame.command) return null;
  const [lat, lon] = [item.params[4] ?? 0, item.params[5] ?? 0];
  return lat === 0 && lon === 0 ? null : [lat, lon];
}

/** Position in `params` of a circle's radius. */
export function radiusIndex(command: number): number {
  return command === kCommand.circleToHeight ? 1 : 2;
}

/** Of a circle, without its side; null = the autopilot's default. */
export function radiusOf(item: SimpleItem): number | null {
  const radius = item.params[radiusIndex(item.command)] ?? 0;
  return radius === 0 ? null : Math.abs(radius);
}

/** The number of mission items before it is the first number of an item; home has number 0. */
export function countOf(item: MissionItem): number {
  return item.kind === 'complex' ? item.count : 1;
}

/** The first number of each item in the mission as it is flown. */
export function numbersOf({ items }: Mission): number[] {
  let next = 1;
  return items.map((item) => {
    const number = next;
    next += countOf(item);
    return number;
  });
}

/** The item to which a number of the mission belongs. */
export function itemOfNumber(mission: Mission, number: number): MissionItem | null {
  const numbers = numbersOf(mission);
  return (
    mission.items.find((item, i) => {
      const first = numbers[i] ?? 0;
      return number >= first && number < first + countOf(item);
    }) ?? null
  );
}

export function withParam(item: SimpleItem, index: number, value: number | null): SimpleItem {
  const params = [...item.params];
  params[index] = value;
  return { ...item, params };
}
