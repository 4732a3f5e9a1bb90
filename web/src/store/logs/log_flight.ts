// The form with which a log is flown, as overrides of a scenario.
import type { FieldError } from '../../protocol/field_errors';
import type { LogInfo } from '../../protocol/log_types';
import type { Json, JsonObject } from '../../protocol/rest_types';

export interface LogFlight {
  /** Scenario that gives world, cameras and all else. */
  scenario: string;
  /** Stream of the positions; empty = the recommended truth. */
  source: string;
  /** By the vehicle's clock; null = from the start, to the end. */
  from_s: number | null;
  to_s: number | null;
  smooth: boolean;
  /** Estimates the time between positions and attitudes; needs `smooth`. */
  autoOffset: boolean;
  /** Moves the flight into the scenario's world. */
  rebase: boolean;
  lowest_agl_m: string;
  turn_deg: string;
  geoid_separation_m: string;
  estimators: string[];
}

export function newLogFlight(scenario: string): LogFlight {
  return {
    scenario,
    source: '',
    from_s: null,
    to_s: null,
    smooth: true,
    autoOffset: false,
    rebase: true,
    lowest_agl_m: '100',
    turn_deg: '0',
    geoid_separation_m: '0',
    estimators: ['feature'],
  };
}

/** @param document  of the scenario: its estimators are kept by name */
export function logOverrides(
  flight: LogFlight,
  file: string,
  document: JsonObject,
): { overrides: Record<string, Json>; errors: FieldError[] } {
  const errors: FieldError[] = [];
  const number = (field: string, text: string): number => {
    const value = Number(text);
    if (text.trim() === '' || !Number.isFinite(value)) {
      errors.push({ field, message: 'must be a number' });
    }
    return value;
  };
  const log: JsonObject = { file };
  if (flight.source !== '') log['source'] = flight.source;
  if (flight.from_s !== null) log['from_s'] = flight.from_s;
  if (flight.to_s !== null) log['to_s'] = flight.to_s;
  if (flight.smooth) log['smooth'] = {};
  if (flight.smooth && flight.autoOffset) log['time_offset_s'] = 'auto';
  const geoid_m = number('flight.log.geoid_separation_m', flight.geoid_separation_m);
  if (geoid_m !== 0) log['geoid_separation_m'] = geoid_m;
  if (flight.rebase) {
    log['rebase'] = {
      lowest_agl_m: number('flight.log.rebase.lowest_agl_m', flight.lowest_agl_m),
      turn_deg: number('flight.log.rebase.turn_deg', flight.turn_deg),
    };
  }
  const overrides: Record<string, Json> = { title: titleOf(file), flight: { log } };
  const known = Array.isArray(document['estimators']) ? document['estimators'] : [];
  overrides['estimators'] = flight.estimators.map(
    (name): Json =>
      known.find(
        (entry) =>
          typeof entry === 'object' &&
          entry !== null &&
          !Array.isArray(entry) &&
          entry['name'] === name,
      ) ?? { name, type: name },
  );
  // The scenario's own flight may be shorter, and begin later.
  if (document['duration_s'] !== undefined) overrides['duration_s'] = kLongest_s;
  if (document['start_s'] !== undefined) overrides['start_s'] = 0;
  return { overrides, errors };
}

const kLongest_s = 86_400;

function titleOf(file: string): string {
  return `Log ${file.slice(file.lastIndexOf('/') + 1)}`;
}

/** Streams that can be flown: with positions of a known place. */
export function flyableSources(info: LogInfo): string[] {
  return info.streams
    .filter(({ positions, georeferenced }) => (positions ?? 0) > 0 && georeferenced === true)
    .map(({ name }) => name);
}
