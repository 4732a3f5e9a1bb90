// What the dashboard learned while a list of runs was on its way.
import type { Run } from '../../protocol/rest_types';

/**
 * A list of the server with what came while it was on its way: runs as the stream has changed them, and
 * runs that were started.
 * @param before  the runs when the list was asked for
 * @param now  the runs when it came
 */
export function withNewer(
  listed: readonly Run[],
  before: readonly Run[],
  now: readonly Run[],
): Run[] {
  const asked = new Set(before);
  const newer = new Map(now.filter((run) => !asked.has(run)).map((run) => [run.id, run]));
  const known = new Set([...before, ...listed].map(({ id }) => id));
  const started = now.filter(({ id }) => !known.has(id));
  const merged = listed.map((run) => {
    const { results, tags, note } = run;
    const streamed = newer.get(run.id);
    return streamed === undefined ? run : { ...streamed, results, tags, note };
  });
  return [...started, ...merged];
}
