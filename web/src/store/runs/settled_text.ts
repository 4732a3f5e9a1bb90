// What a list entry of a run shows but for its progress, as text to compare.
import type { Run } from '../../protocol/rest_types';

/** What changes while a run waits and flies. */
const kNoProgress = { frames: 0, duration_ns: 0, queue_position: null, left_s: null, notice: null };

/**
 * Equal for two states of a run that differ only in progress, in whatever order they have their fields: the list of
 * runs and the stream of a watched run give the same fields in different orders.
 */
export function settledText(run: Run): string {
  const fields = Object.entries({ ...run, ...kNoProgress });
  return JSON.stringify(fields.sort(([a], [b]) => (a < b ? -1 : 1)));
}
