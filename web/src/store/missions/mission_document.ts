// Scenarios that fly a mission: made of another scenario, a world and the mission.
import type { World } from '../../protocol/mission_types';
import type { Json, JsonObject } from '../../protocol/rest_types';
import { metresPerDegree } from '../metres_per_degree';
import { movedTo } from './mission_edit';
import type { Mission } from './mission_item';
import { isObject, planFromMission } from './plan_file';

/** Settings of `flight.mission` other than the mission itself. */
export interface FlightSettings {
  airframe: string;
  airspeed_m_s: number;
  turbulence: string;
  wind_from_deg: number;
  wind_m_s: number;
  /** What is edited elsewhere. */
  rest: JsonObject;
}

export const kUsualFlight: FlightSettings = {
  airframe: 'piper_cub_third',
  airspeed_m_s: 25,
  turbulence: 'none',
  wind_from_deg: 270,
  wind_m_s: 0,
  rest: {},
};

/** The settings of a scenario that flies a mission, else the usual ones. */
export function flightOf(document: JsonObject): FlightSettings {
  const flight = document['flight'];
  const mission = isObject(flight) ? flight['mission'] : undefined;
  if (!isObject(mission)) return { ...kUsualFlight };
  const {
    file: _file,
    plan: _plan,
    home: _home,
    airframe,
    airspeed_m_s,
    turbulence,
    wind,
    ...rest
  } = mission;
  void [_file, _plan, _home];
  return {
    airframe: text(airframe, kUsualFlight.airframe),
    airspeed_m_s: number(airspeed_m_s, kUsualFlight.airspeed_m_s),
    turbulence: text(turbulence, kUsualFlight.turbulence),
    wind_from_deg: number(isObject(wind) ? wind['from_deg'] : undefined, 270),
    wind_m_s: number(isObject(wind) ? wind['speed_m_s'] : undefined, 0),
    rest,
  };
}

/**
 * The scenario that flies a mission.
 * @param base  gives cameras, estimators, sensors, pacing and everything else
 * @param title  '' = the base's
 */
export function missionDocument(
  base: JsonObject,
  world: JsonObject,
  title: string,
  settings: FlightSettings,
  mission: Mission,
): JsonObject {
  const { airframe, airspeed_m_s, turbulence, wind_from_deg, wind_m_s, rest } = settings;
  const flight: JsonObject = {
    ...rest,
    airframe,
    airspeed_m_s,
    turbulence,
    home: 'file',
    plan: planFromMission(mission),
  };
  if (wind_m_s > 0) flight['wind'] = { from_deg: wind_from_deg, speed_m_s: wind_m_s };
  const { description: _description, ...kept } = base;
  void _description;
  return {
    ...kept,
    ...(title.trim() === '' ? {} : { title: title.trim() }),
    world,
    flight: { mission: flight },
  };
}

/** Where a scenario moves its mission's home; null = as in the mission. */
export function homeOf(document: JsonObject, world: World): [number, number] | null {
  const flight = document['flight'];
  const mission = isObject(flight) ? flight['mission'] : undefined;
  const home = isObject(mission) ? mission['home'] : undefined;
  if (home === 'runway' && world.runway !== null) {
    return [world.runway.lat_deg, world.runway.lon_deg];
  }
  if (!isObject(home)) return null;
  const { origin } = world;
  const lat_deg =
    origin.lat_deg + number(home['north_m'], 0) / metresPerDegree(origin.lat_deg).north;
  const lon_deg = origin.lon_deg + number(home['east_m'], 0) / metresPerDegree(lat_deg).east;
  return [lat_deg, lon_deg];
}

/** The mission where the scenario flies it. */
export function asFlown(mission: Mission, document: JsonObject, world: World): Mission {
  const home = homeOf(document, world);
  return home === null ? mission : movedTo(mission, home);
}

export function camerasOf(document: JsonObject): string[] {
  const { cameras } = document;
  if (!Array.isArray(cameras)) return ['camera0'];
  return cameras.map((camera, i) => text(isObject(camera) ? camera['name'] : undefined, `${i}`));
}

export function isInside({ bounds }: World, lat_deg: number, lon_deg: number): boolean {
  const turn = (deg: number) => ((((deg + 180) % 360) + 360) % 360) - 180;
  const middle = (bounds.west_deg + bounds.east_deg) / 2;
  const half = (bounds.east_deg - bounds.west_deg) / 2;
  return (
    lat_deg >= bounds.south_deg &&
    lat_deg <= bounds.north_deg &&
    Math.abs(turn(lon_deg - middle)) <= half
  );
}

/** A name for a file: letters, digits, `_` and `-`. */
export function fileNameOf(title: string): string {
  const name = title
    .normalize('NFKD')
    .replace(/[\u0300-\u036f]/g, '')
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, '_')
    .replace(/^_+|_+$/g, '')
    .slice(0, 48);
  return name === '' ? 'mission' : name;
}

/** A name that no scenario has. */
export function freeName(wanted: string, scenarios: readonly { name: string }[] | null): string {
  const names = new Set(scenarios?.map(({ name }) => name));
  let name = wanted;
  for (let i = 2; names.has(name); i += 1) name = `${wanted}_${i}`;
  return name;
}

function text(value: Json | undefined, absent: string): string {
  return typeof value === 'string' ? value : absent;
}

function number(value: Json | undefined, absent: number): number {
  return typeof value === 'number' && Number.isFinite(value) ? value : absent;
}
