// The worlds of the server on the map of a log: where they lie, and the flight moved to one.
import type { RestClient } from '../../connection/rest_client';
import type { WorldExtent } from '../../protocol/log_types';
import type { Store } from '../state';
import type { Track } from './log_track';
import { metresPerDegree } from '../metres_per_degree';

/** Of a world's imagery, east and north of a track's origin [m]. */
export interface Outline {
  name: string;
  east_m: number[];
  north_m: number[];
  /** The flight is flown over it. */
  chosen: boolean;
}

type Place = WorldExtent['centre'];

/** An outline on the plane of a track that begins at `origin`. */
export function outlineOf(world: WorldExtent, origin: Place, chosen: boolean): Outline {
  const scale = metresPerDegree(origin.lat_deg);
  const turn = (deg: number) => ((((deg + 180) % 360) + 360) % 360) - 180;
  return {
    name: world.name,
    east_m: world.outline.map(({ lon_deg }) => turn(lon_deg - origin.lon_deg) * scale.east),
    north_m: world.outline.map(({ lat_deg }) => (lat_deg - origin.lat_deg) * scale.north),
    chosen,
  };
}

/**
 * The track as the server moves it: turned clockwise, and the centre of the slice's extent put on
 * that of the world's imagery.
 */
export function movedTrack(
  track: Track,
  world: WorldExtent,
  turn_deg: number,
  slice: readonly [number, number] | null,
): Track {
  const inside = (_: number, i: number) => {
    const t_s = track.t_s[i] ?? 0;
    return slice === null || (t_s >= slice[0] && t_s <= slice[1]);
  };
  const middle = (values: readonly number[]) => {
    const own = values.filter(inside);
    if (own.length === 0) return 0;
    const [low, high] = own.reduce(
      ([least, most], v) => [Math.min(least, v), Math.max(most, v)],
      [Infinity, -Infinity],
    );
    return (low + high) / 2;
  };
  const east = middle(track.east_m);
  const north = middle(track.north_m);
  const [sine, cosine] = [Math.sin, Math.cos].map((of) => of((turn_deg * Math.PI) / 180)) as [
    number,
    number,
  ];
  return {
    t_s: track.t_s,
    east_m: track.east_m.map(
      (e, i) => (e - east) * cosine + ((track.north_m[i] ?? 0) - north) * sine,
    ),
    north_m: track.north_m.map(
      (n, i) => (n - north) * cosine - ((track.east_m[i] ?? 0) - east) * sine,
    ),
    origin: world.centre,
  };
}

/** The share of a track's points (in the slice) that lie outside of an outline. */
export function shareOutside(
  track: Track,
  outline: Outline,
  slice: readonly [number, number] | null,
): number {
  const own = track.t_s.flatMap((t_s, i) =>
    slice === null || (t_s >= slice[0] && t_s <= slice[1]) ? [i] : [],
  );
  const outside = own.filter(
    (i) => !contains(outline, track.east_m[i] ?? 0, track.north_m[i] ?? 0),
  ).length;
  return own.length === 0 ? 0 : outside / own.length;
}

/** By the number of sides to the east (even-odd rule). */
function contains({ east_m, north_m }: Outline, east: number, north: number): boolean {
  let inside = false;
  east_m.forEach((e1, i) => {
    const before = (i + east_m.length - 1) % east_m.length;
    const [e0, n0, n1] = [east_m[before] ?? 0, north_m[before] ?? 0, north_m[i] ?? 0];
    const crosses = n0 > north !== n1 > north;
    if (crosses && east < e0 + ((north - n0) / (n1 - n0)) * (e1 - e0)) inside = !inside;
  });
  return inside;
}

/** Reads the extents while the page of logs is open, the chosen scenario's first. */
export class LogWorlds {
  private reading = false;

  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
  ) {}

  async refresh(): Promise<void> {
    if (this.reading) return;
    this.reading = true;
    for (let next = this.next(); next !== undefined; next = this.next()) {
      const { worlds } = this.store.state.logPage;
      try {
        worlds.set(next, await this.rest.worldExtent(next));
        this.store.change('logs');
      } catch {
        // Not made yet, or its files are missing: the map does without it.
        worlds.set(next, null);
      }
    }
    this.reading = false;
  }

  private next(): string | undefined {
    const { scenarios, logPage } = this.store.state;
    if (!logPage.open) return undefined;
    const names = (scenarios ?? []).filter(({ error }) => error === null).map(({ name }) => name);
    const order = [logPage.flight.scenario, ...names].filter((name) => names.includes(name));
    return order.find((name) => !logPage.worlds.has(name));
  }
}
