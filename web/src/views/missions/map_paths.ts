// The parts of a mission's path that are drawn differently.
import type { MissionReport, MissionSamples } from '../../protocol/mission_types';

export interface PathPart {
  kind: 'plain' | 'start' | 'warned';
  points: [number, number][];
}

/** Consecutive parts: with warnings, the beginning for estimators, the rest. */
export function pathParts({ samples, start, warnings }: MissionReport): PathPart[] {
  const spans = warnings.flatMap(({ from_s, to_s, kind }) =>
    from_s === null || to_s === null || kind === 'start' ? [] : [[from_s, to_s] as const],
  );
  const kindAt = (t_s: number): PathPart['kind'] => {
    if (spans.some(([from, to]) => t_s >= from && t_s <= to)) return 'warned';
    if (start?.enough === true && t_s >= start.from_s && t_s <= start.to_s) return 'start';
    return 'plain';
  };
  const parts: PathPart[] = [];
  samples.t_s.forEach((t_s, i) => {
    const kind = kindAt(t_s);
    const point: [number, number] = [samples.lat_deg[i] ?? 0, samples.lon_deg[i] ?? 0];
    const last = parts.at(-1);
    if (last?.kind === kind) {
      last.points.push(point);
      return;
    }
    // Parts share their ends.
    last?.points.push(point);
    parts.push({ kind, points: [point] });
  });
  return parts;
}

/** Index of the sample at a distance along the mission; null without samples. */
export function cursorSample({ distance_m }: MissionSamples, at_m: number): number | null {
  if (distance_m.length === 0) return null;
  let [low, high] = [0, distance_m.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((distance_m[middle] ?? 0) <= at_m) low = middle;
    else high = middle;
  }
  return Math.abs((distance_m[low] ?? 0) - at_m) <= Math.abs((distance_m[high] ?? 0) - at_m)
    ? low
    : high;
}

/** Index of the sample at a time. */
export function sampleAt({ t_s }: MissionSamples, at_s: number): number {
  const index = t_s.findIndex((t) => t >= at_s);
  return index < 0 ? t_s.length - 1 : index;
}
