// The clock and the shown run at its time.
import type { Playback, RunInstant } from '../protocol/messages';

/** Times are those of the clock. */
export type RunPlayback = Omit<Playback, 'runs'> &
  Pick<RunInstant, 'frame' | 'alignment' | 'truth' | 'estimates'>;

/** null if the message does not contain the run. */
export function playbackOf(message: Playback, runId: string | null): RunPlayback | null {
  const instant = runId === null ? undefined : message.runs[runId];
  if (instant === undefined) return null;
  const { t_ns, playing, live, speed, loop, range, begin_ns, end_ns, flying } = message;
  const clock = { t_ns, playing, live, speed, loop, range, begin_ns, end_ns, flying };
  const { frame, alignment, truth, estimates } = instant;
  return { ...clock, frame, alignment, truth, estimates };
}
