// Playback control: every action becomes a command to the server, which answers with the cursor's
// position.
import type { ClientMessage } from '../protocol/messages';
import type { Session } from './session';
import type { Store } from './state';
import { nearestIndex } from './table';

export const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50] as const;

export class Player {
  constructor(
    private readonly store: Store,
    private readonly session: Session,
  ) {}

  togglePlay(): void {
    const { playback } = this.store.state;
    if (playback === null) return;
    const atEnd = !playback.live && playback.t_ns >= playback.end_ns;
    if (!playback.playing && atEnd) this.command({ type: 'seek', t_ns: playback.begin_ns });
    this.command({ type: playback.playing ? 'pause' : 'play' });
  }

  step(frames: number): void {
    this.command({ type: 'step', frames });
  }

  /**
   * Seeks to the frame nearest to a time, so that every panel has a picture of exactly that
   * instant.
   */
  seekTime(t_ns: number): void {
    const { truth } = this.store.state.data;
    const row = nearestIndex(truth.column('t_ns'), t_ns);
    if (row < 0) this.command({ type: 'seek', t_ns: Math.round(t_ns) });
    else this.command({ type: 'seek', frame: truth.at('frame', row) });
  }

  seekBy(delta_ns: number): void {
    const { playback } = this.store.state;
    if (playback !== null) this.seekTime(playback.t_ns + delta_ns);
  }

  seekEdge(edge: 'begin' | 'end'): void {
    const { playback } = this.store.state;
    if (playback !== null) this.seekTime(edge === 'begin' ? playback.begin_ns : playback.end_ns);
  }

  setSpeed(value: number): void {
    this.store.state.wantedSpeed = value;
    this.command({ type: 'speed', value });
  }

  changeSpeed(direction: 1 | -1): void {
    const { playback, wantedSpeed } = this.store.state;
    const speed = wantedSpeed ?? playback?.speed ?? 1;
    const next =
      direction > 0
        ? kSpeeds.find((value) => value > speed * 1.001)
        : kSpeeds.findLast((value) => value < speed * 0.999);
    if (next !== undefined) this.setSpeed(next);
  }

  toggleLoop(): void {
    const { playback } = this.store.state;
    if (playback !== null) this.command({ type: 'loop', value: !playback.loop });
  }

  goLive(): void {
    if (this.store.state.run?.status === 'running') this.command({ type: 'live' });
  }

  private command(message: ClientMessage): void {
    this.session.command(message);
  }
}
