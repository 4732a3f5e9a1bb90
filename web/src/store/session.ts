// Watching one run: takes the stream's messages into the store and turns the viewer's wishes
// into commands.
import type { ConnectionState, StreamClient, StreamListener } from '../connection/stream_client';
import type {
  ClientMessage,
  PictureStream,
  Playback,
  Resume,
  SceneMode,
  ServerMessage,
} from '../protocol/messages';
import type { PictureMessage } from '../protocol/parse';
import type { Run } from '../protocol/rest_types';
import type { Decode } from './picture_decoder';
import { PictureDecoder } from './picture_decoder';
import { RunData } from './run_data';
import type { Notices } from './notices';
import type { SceneOrbit, Store } from './state';
import { nearestIndex } from './table';

export const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 5, 10, 20, 50] as const;

const kDistanceRange_m = [5, 20000] as const;
const kElevationRange_deg = [-10, 90] as const;

export class Session implements StreamListener {
  private client: StreamClient | null = null;
  private readonly decoder: PictureDecoder;
  /** Where to go once the run just attached tells its playback. */
  private pendingSeek_ns: number | null = null;
  private pictureWidth_px = 640;
  private subscribed = '';

  constructor(
    private readonly store: Store,
    private readonly notices: Notices,
    decode: Decode,
  ) {
    this.decoder = new PictureDecoder(
      decode,
      (name, picture) => {
        this.store.state.pictures.get(name)?.bitmap.close();
        this.store.state.pictures.set(name, picture);
        this.store.change('pictures');
      },
      (text) => this.notices.error(text),
    );
  }

  use(client: StreamClient): void {
    this.client = client;
  }

  // ---- what the viewer wants -------------------------------------------------------------------

  /** Watches a run from `t_ns` on, or from where the server starts it. */
  selectRun(id: string | null, t_ns: number | null = null): void {
    const { state } = this.store;
    if (id !== null && id === state.runId) {
      if (t_ns !== null) this.seekTime(t_ns);
      return;
    }
    this.decoder.clear();
    for (const picture of state.pictures.values()) picture.bitmap.close();
    state.pictures.clear();
    state.runId = id;
    state.run = state.runs?.find((run) => run.id === id) ?? null;
    state.data = new RunData();
    state.metrics = null;
    state.playback = null;
    this.pendingSeek_ns = t_ns;
    this.subscribed = '';
    this.client?.attach(id);
    this.store.change('run', 'rows', 'log', 'metrics', 'playback', 'pictures', 'scene');
  }

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

  /** Goes to the frame nearest to a time, so that every panel has a picture of that very instant. */
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
    this.command({ type: 'speed', value });
  }

  changeSpeed(direction: 1 | -1): void {
    const speed = this.store.state.playback?.speed ?? 1;
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

  setSceneMode(mode: SceneMode): void {
    const { state } = this.store;
    state.sceneMode = mode;
    this.client?.setView({ mode, ...state.sceneOrbits[mode] });
    this.store.change('scene');
  }

  orbit(change: Partial<SceneOrbit>): void {
    const { state } = this.store;
    const orbit = { ...state.sceneOrbits[state.sceneMode], ...change };
    orbit.azimuth_deg = ((orbit.azimuth_deg % 360) + 360) % 360;
    orbit.elevation_deg = clamp(orbit.elevation_deg, kElevationRange_deg);
    orbit.distance_m = clamp(orbit.distance_m, kDistanceRange_m);
    state.sceneOrbits[state.sceneMode] = orbit;
    this.client?.setView({ mode: state.sceneMode, ...orbit });
    this.store.change('scene');
  }

  toggleFollow(): void {
    const { state } = this.store;
    this.orbit({ follow: !state.sceneOrbits[state.sceneMode].follow });
  }

  setSceneSize(width_px: number, height_px: number): void {
    this.client?.setView({ width_px, height_px });
  }

  /** How wide camera and debug images are shown, in device pixels. */
  setPictureWidth(width_px: number): void {
    this.pictureWidth_px = width_px;
    this.subscribe();
  }

  // ---- what the stream tells -------------------------------------------------------------------

  onState(state: ConnectionState): void {
    this.store.state.connection = state;
    if (state.status === 'open') this.subscribed = '';
    this.store.change('connection');
  }

  onMessage(message: ServerMessage): void {
    const { state } = this.store;
    if (message.type === 'run') {
      this.onRun(message.run);
    } else if (message.type === 'rows') {
      this.onRows(message);
    } else if (message.type === 'metrics') {
      state.metrics = message.metrics;
      this.store.change('metrics');
    } else if (message.type === 'playback') {
      this.onPlayback(message);
    } else if (message.type === 'error') {
      this.notices.error(message.message);
    }
  }

  onAttachFailed(run: string, message: string): void {
    if (this.store.state.runId === run) this.selectRun(null);
    this.notices.error(`Run ${run} cannot be shown: ${message}`);
  }

  onPicture(name: string, picture: PictureMessage): void {
    this.decoder.push(name, picture);
  }

  onFault(text: string): void {
    this.notices.error(`The server sent something unreadable: ${text}`);
  }

  resume(): Resume {
    return this.store.state.data.resume();
  }

  restore(): ClientMessage[] {
    const { playback } = this.store.state;
    if (playback === null) return [];
    const commands: ClientMessage[] = [];
    if (playback.speed !== 1) commands.push({ type: 'speed', value: playback.speed });
    if (playback.loop) commands.push({ type: 'loop', value: true });
    if (!playback.live) {
      commands.push({ type: 'seek', t_ns: playback.t_ns });
      commands.push({ type: playback.playing ? 'play' : 'pause' });
    }
    return commands;
  }

  private onRun(run: Run): void {
    const { state } = this.store;
    state.run = run;
    const index = state.runs?.findIndex(({ id }) => id === run.id) ?? -1;
    if (state.runs !== null && index >= 0) state.runs[index] = run;
    this.subscribe();
    this.store.change('run', 'lists');
  }

  private onRows(rows: ServerMessage & { type: 'rows' }): void {
    const { state } = this.store;
    if (state.data.apply(rows)) this.store.change(rows.stream === 'log' ? 'log' : 'rows');
    else if (state.runId !== null) this.client?.attach(state.runId);
  }

  private onPlayback(playback: Playback): void {
    this.store.state.playback = playback;
    this.store.change('playback');
    if (this.pendingSeek_ns === null) return;
    const t_ns = this.pendingSeek_ns;
    this.pendingSeek_ns = null;
    this.command({ type: 'seek', t_ns });
    if (playback.playing) this.command({ type: 'pause' });
  }

  private subscribe(): void {
    const { run } = this.store.state;
    if (run === null || this.store.state.runId === null) return;
    const max_width_px = this.pictureWidth_px;
    const streams: PictureStream[] = [
      { name: 'scene', max_hz: 20, quality: 80 },
      { name: 'camera', max_hz: 31, quality: 75, max_width_px },
      ...run.estimators.map((name) => ({
        name: `debug/${name}`,
        max_hz: 15,
        quality: 75,
        max_width_px,
      })),
    ];
    const key = JSON.stringify(streams);
    if (key === this.subscribed) return;
    this.subscribed = key;
    this.client?.subscribe(streams);
  }

  private command(message: ClientMessage): void {
    if (this.store.state.runId !== null) this.client?.command(message);
  }
}

function clamp(value: number, [low, high]: readonly [number, number]): number {
  return Math.min(high, Math.max(low, value));
}
