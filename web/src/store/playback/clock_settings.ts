// How the clock plays, and the commands that make it so.
import type { ClientMessage } from '../../protocol/messages';
import type { Clock } from './run_playback';

export type ClockSettings = Pick<Clock, 'range' | 'speed' | 'loop'>;

/** As the server begins. */
export const kUsualClock: ClockSettings = {
  range: null,
  speed: 1,
  loop: false,
};

/** What makes a clock play in a wanted way. */
export function settingCommands(wanted: ClockSettings, now: ClockSettings): ClientMessage[] {
  const { range, speed, loop } = wanted;
  const commands: ClientMessage[] = [];
  if (speed !== now.speed) commands.push({ type: 'speed', value: speed });
  if (loop !== now.loop) commands.push({ type: 'loop', value: loop });
  if (range?.begin_ns !== now.range?.begin_ns || range?.end_ns !== now.range?.end_ns) {
    commands.push({ type: 'range', ...range });
  }
  return commands;
}

/**
 * What brings the clock of a new connection to where it was; whether one is live says the server.
 */
export function restoringCommands(clock: Clock): ClientMessage[] {
  const commands = settingCommands(clock, kUsualClock);
  if (clock.live) return commands;
  const { t_ns, playing } = clock;
  return [...commands, { type: 'seek', t_ns }, { type: playing ? 'play' : 'pause' }];
}
