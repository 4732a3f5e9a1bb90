// Flight modes of a log as bands of time, and its other events as marks.
import type { LogEvent, LogSeries } from '../../protocol/log_types';

export interface Band {
  begin_s: number;
  end_s: number;
  text: string;
}

export interface Mark {
  t_s: number;
  kind: string;
  text: string;
}

/** "mode 10 (AUTO)" -> "AUTO" */
export function modeName(text: string): string {
  return /\(([^)]+)\)/.exec(text)?.[1] ?? text;
}

/** Those of the vehicle, and the run of its clock, whose series are shown: other times mean others. */
export function eventsOf(
  events: readonly LogEvent[],
  { vehicle, run }: Pick<LogSeries, 'vehicle' | 'run'>,
): LogEvent[] {
  return events.filter((event) => (event.vehicle ?? '') === vehicle && event.run === run);
}

/** Each mode lasts until the next one, the last one to the end of the log. */
export function modeBands(events: readonly LogEvent[], end_s: number): Band[] {
  const bands: Band[] = [];
  const modes = events
    .filter(
      (event): event is LogEvent & { t_s: number } => event.kind === 'mode' && event.t_s !== null,
    )
    .sort((a, b) => a.t_s - b.t_s);
  for (const { t_s, text } of modes) {
    const name = modeName(text);
    const last = bands.at(-1);
    if (last !== undefined) last.end_s = t_s;
    if (last?.text === name) continue;
    bands.push({ begin_s: t_s, end_s: Math.max(end_s, t_s), text: name });
  }
  const last = bands.at(-1);
  if (last !== undefined) last.end_s = Math.max(end_s, last.begin_s);
  return bands;
}

const kMarked: ReadonlySet<string> = new Set(['arming', 'mission', 'text', 'other']);

export function marksOf(events: readonly LogEvent[]): Mark[] {
  return events.flatMap(({ t_s, kind, text }) =>
    t_s !== null && kMarked.has(kind) ? [{ t_s, kind, text }] : [],
  );
}

export function marksWithin(
  marks: readonly Mark[],
  [begin_s, end_s]: readonly [number, number],
): Mark[] {
  return marks.filter(({ t_s }) => t_s >= begin_s && t_s <= end_s);
}

/** The same colour for the same name everywhere. */
export function bandHue(name: string): number {
  let hash = 0;
  for (const letter of name) hash = (Math.imul(hash, 31) + (letter.codePointAt(0) ?? 0)) | 0;
  // Hues of similar names are far apart.
  return (((hash % 360) + 360) * 137) % 360;
}
