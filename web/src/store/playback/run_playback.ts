// The clock and the main run at its time.
import type { Playback, RunInstant } from '../../protocol/messages';

/** Times are those of the clock. */
export type Clock = Omit<Playback, 'runs'>;

/** Times are those of the clock. */
export type RunPlayback = Clock & Pick<RunInstant, 'frame' | 'alignment' | 'truth' | 'estimates'>;

export function clockOf(message: Playback): Clock {
  const { t_ns, playing, live, speed, loop, range, begin_ns, end_ns, flying } = message;
  return { t_ns, playing, live, speed, loop, range, begin_ns, end_ns, flying };
}
