// Places within surveys, corridors, structure scans and landing patterns, as QGroundControl writes them.
import type { Json, JsonObject } from '../../protocol/rest_types';
import { kFrame } from './mission_item';
import { isObject } from './plan_file';

type Move = (lat_deg: number, lon_deg: number) => [number, number];

/** Lists of places, each with or without a height. */
const kListsOfPlaces = new Set(['polygon', 'polyline', 'VisualTransectPoints']);
/** One place: landCoordinate, landingApproachCoordinate, loiterCoordinate, ... */
const kPlace = /[cC]oordinate$/;

/** A complex item with all its places moved; the rest of it stays as it is. */
export function movedRaw(raw: JsonObject, move: Move): JsonObject {
  const entries = Object.entries(raw).map(([name, value]): [string, Json] => {
    if (kPlace.test(name)) return [name, movedPlace(value, move)];
    if (kListsOfPlaces.has(name) && Array.isArray(value)) {
      return [name, value.map((place) => movedPlace(place, move))];
    }
    if (name === 'params' && isPlaced(raw['frame'])) {
      return [name, movedParams(value, move)];
    }
    return [name, movedPart(value, move)];
  });
  return Object.fromEntries(entries);
}

function isPlaced(frame: Json | undefined): boolean {
  return typeof frame === 'number' && frame !== kFrame.command;
}

function movedPart(value: Json, move: Move): Json {
  if (Array.isArray(value)) return value.map((part) => movedPart(part, move));
  return isObject(value) ? movedRaw(value, move) : value;
}

function movedPlace(value: Json, move: Move): Json {
  if (!Array.isArray(value)) return value;
  const [lat_deg, lon_deg, ...height] = value;
  if (typeof lat_deg !== 'number' || typeof lon_deg !== 'number') return value;
  return [...move(lat_deg, lon_deg), ...height];
}

/** Of a mission item; 0, 0 is no place. */
function movedParams(value: Json, move: Move): Json {
  if (!Array.isArray(value)) return value;
  const [lat_deg, lon_deg] = value.slice(4);
  if (typeof lat_deg !== 'number' || typeof lon_deg !== 'number') return value;
  if (lat_deg === 0 && lon_deg === 0) return value;
  return [...value.slice(0, 4), ...move(lat_deg, lon_deg), ...value.slice(6)];
}
