// The positions of a log as points on a plane, for a map.
import type { LogSeries } from '../../protocol/log_types';
import { metresPerDegree } from '../metres_per_degree';

/** East and north of the track's first point [m]. */
export interface Track {
  t_s: number[];
  east_m: number[];
  north_m: number[];
  /** null: the log does not say where it was. */
  origin: { lat_deg: number; lon_deg: number } | null;
}

export function trackOf(series: LogSeries): Track {
  const { t_s = [], lat_deg, lon_deg, north_m, east_m } = series.positions;
  if (lat_deg === undefined || lon_deg === undefined) {
    return { t_s, east_m: east_m ?? [], north_m: north_m ?? [], origin: null };
  }
  const origin = { lat_deg: lat_deg[0] ?? 0, lon_deg: lon_deg[0] ?? 0 };
  const scale = metresPerDegree(origin.lat_deg);
  const turn = (deg: number) => ((((deg + 180) % 360) + 360) % 360) - 180;
  return {
    t_s,
    east_m: lon_deg.map((lon) => turn(lon - origin.lon_deg) * scale.east),
    north_m: lat_deg.map((lat) => (lat - origin.lat_deg) * scale.north),
    origin,
  };
}

export function placeText(track: Track, east_m: number, north_m: number): string {
  const metres = `E ${east_m.toFixed(0)} m, N ${north_m.toFixed(0)} m`;
  if (track.origin === null) return metres;
  const scale = metresPerDegree(track.origin.lat_deg);
  const lat = track.origin.lat_deg + north_m / scale.north;
  const lon = track.origin.lon_deg + east_m / scale.east;
  return `${metres} · ${lat.toFixed(6)}°, ${lon.toFixed(6)}°`;
}

/** The longest of 1, 2, 5, 10, ... m that is at most `longest_m`. */
export function scaleBar_m(longest_m: number): number {
  const power = Math.pow(10, Math.floor(Math.log10(longest_m)));
  const digit = longest_m / power;
  return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

/** Row whose time is nearest; -1 if there are none. @pre times increase */
export function nearestRow(times: readonly number[], t_s: number): number {
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((times[middle] ?? 0) <= t_s) low = middle;
    else high = middle;
  }
  if (times.length === 0) return -1;
  return Math.abs((times[high] ?? 0) - t_s) < Math.abs((times[low] ?? 0) - t_s) ? high : low;
}

/** Values with null where a line must break: across long gaps, and where an angle wraps. */
export function broken(
  times: readonly number[],
  values: readonly number[],
  wraps: boolean,
): { t_s: number[]; values: (number | null)[] } {
  const steps = times.slice(1).map((t, i) => t - (times[i] ?? t));
  const usual = [...steps].sort((a, b) => a - b)[Math.floor(steps.length * 0.9)] ?? 0;
  const longest_s = Math.max(2, 5 * usual);
  const out = { t_s: [] as number[], values: [] as (number | null)[] };
  times.forEach((t, i) => {
    const value = values[i] ?? null;
    const before = values[i - 1];
    const gap = i > 0 && (steps[i - 1] ?? 0) > longest_s;
    const turn = wraps && before !== undefined && value !== null && Math.abs(value - before) > 180;
    if (gap || turn) {
      out.t_s.push((t + (times[i - 1] ?? t)) / 2);
      out.values.push(null);
    }
    out.t_s.push(t);
    out.values.push(value);
  });
  return out;
}
