// Playback control: every action becomes a command to the server, which answers with the cursor's
// position.
import type { ClientMessage } from '../../protocol/messages';
import type { Session } from '../session';
import type { Store } from '../state';
import { nearestIndex } from '../table';

export const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50] as const;

export class Player {
  constructor(
    private readonly store: Store,
    private readonly session: Session,
  ) {}

  togglePlay(): void {
    const { clock } = this.store.state;
    if (clock !== null) this.command({ type: clock.playing ? 'pause' : 'play' });
  }

  /** Moves by frames of the main run. */
  step(frames: number): void {
    const { runId } = this.store.state;
    if (runId !== null) this.command({ type: 'step', frames, run: runId });
  }

  /**
   * Seeks to the frame of the main run nearest to a time of the clock, so that every panel has a
   * picture of exactly that instant. Outside of this run seeks to the time itself.
   */
  seekTime(t_ns: number): void {
    const { data, runId } = this.store.state;
    const row = this.rowNear(t_ns);
    if (row === null || runId === null) {
      this.command({ type: 'seek', t_ns: Math.round(t_ns) });
    } else {
      this.command({ type: 'seek', frame: data.truth.at('frame', row), run: runId });
    }
  }

  /** The time to which seekTime() moves the clock. */
  seekTarget_ns(t_ns: number): number {
    const { data, offset_ns } = this.store.state;
    const row = this.rowNear(t_ns);
    return row === null ? t_ns : data.truth.at('t_ns', row) + offset_ns;
  }

  /** Row of the main run's frame nearest to a time of the clock; null outside of this run. */
  private rowNear(t_ns: number): number | null {
    const { data, offset_ns } = this.store.state;
    const { truth } = data;
    const run_ns = t_ns - offset_ns;
    if (truth.length === 0 || run_ns < 0 || run_ns > truth.last('t_ns')) return null;
    return nearestIndex(truth.column('t_ns'), run_ns);
  }

  seekBy(delta_ns: number): void {
    const { clock } = this.store.state;
    if (clock !== null) this.seekTime(clock.t_ns + delta_ns);
  }

  seekEdge(edge: 'begin' | 'end'): void {
    const { clock } = this.store.state;
    if (clock !== null) this.seekTime(edge === 'begin' ? clock.begin_ns : clock.end_ns);
  }

  /** Keeps the direction. */
  setSpeed(magnitude: number): void {
    this.sendSpeed(this.direction() * magnitude);
  }

  changeSpeed(change: 1 | -1): void {
    const magnitude = Math.abs(this.speed());
    const next =
      change > 0
        ? kSpeeds.find((value) => value > magnitude * 1.001)
        : kSpeeds.filter((value) => value < magnitude * 0.999).at(-1);
    if (next !== undefined) this.setSpeed(next);
  }

  /** Plays backwards, or forwards again. */
  reverse(): void {
    this.sendSpeed(-this.speed());
  }

  toggleLoop(): void {
    const { clock } = this.store.state;
    if (clock !== null) this.command({ type: 'loop', value: !clock.loop });
  }

  /** Sets one end of the range to play to the clock's time; the other end stays. */
  setRangeEnd(end: 'begin' | 'end'): void {
    const { clock } = this.store.state;
    if (clock === null) return;
    const now_ns = clock.t_ns;
    const old = clock.range ?? { begin_ns: clock.begin_ns, end_ns: clock.end_ns };
    const range =
      end === 'begin'
        ? { begin_ns: now_ns, end_ns: old.end_ns > now_ns ? old.end_ns : clock.end_ns }
        : { begin_ns: old.begin_ns < now_ns ? old.begin_ns : clock.begin_ns, end_ns: now_ns };
    if (range.begin_ns < range.end_ns) this.command({ type: 'range', ...range });
  }

  clearRange(): void {
    this.command({ type: 'range' });
  }

  goLive(): void {
    if (this.store.state.clock?.flying === true) this.command({ type: 'live' });
  }

  private speed(): number {
    const { clock, wantedSpeed } = this.store.state;
    return wantedSpeed ?? clock?.speed ?? 1;
  }

  private direction(): 1 | -1 {
    return this.speed() < 0 ? -1 : 1;
  }

  private sendSpeed(value: number): void {
    this.store.state.wantedSpeed = value;
    this.command({ type: 'speed', value });
  }

  private command(message: ClientMessage): void {
    this.session.command(message);
  }
}
