// Watches one run: requests it and stores what the stream sends about it.
import type { ConnectionState, StreamClient, StreamListener } from '../connection/stream_client';
import type { ClientMessage, PictureStream, Resume, ServerMessage } from '../protocol/messages';
import type { PictureMessage } from '../protocol/parse';
import type { Run } from '../protocol/rest_types';
import type { Decode } from './picture_decoder';
import { PictureDecoder } from './picture_decoder';
import { pictureRates } from './picture_rates';
import { RunData } from './run_data';
import type { RunPlayback } from './run_playback';
import { playbackOf } from './run_playback';
import type { Notices } from './notices';
import type { Store } from './state';

export class Session implements StreamListener {
  private client: StreamClient | null = null;
  private readonly decoder: PictureDecoder;
  /** Where to seek when the watched run sends its playback. */
  private pendingSeek_ns: number | null = null;
  /**
   * Position of a live viewer when the connection was lost; used if the run has ended meanwhile.
   */
  private livePlace_ns: number | null = null;
  private pictureWidth_px = 640;
  private subscribed = '';
  /** The latest message about the watched run's world. */
  private saidOfWorld: string | null = null;

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

  // ---- commands of the viewer ------------------------------------------------------------------

  /** Watches a run from `t_ns` on, or from the server's default position. */
  selectRun(id: string | null, t_ns: number | null = null): void {
    const { state } = this.store;
    if (id !== null && id === state.runId) {
      if (t_ns !== null) this.command({ type: 'seek', t_ns });
      return;
    }
    this.decoder.clear();
    for (const picture of state.pictures.values()) picture.bitmap.close();
    state.pictures.clear();
    state.runId = id;
    state.run = state.runs?.find((run) => run.id === id) ?? null;
    state.data = new RunData();
    state.metrics = null;
    state.statuses = {};
    state.playback = null;
    state.series = [];
    state.wantedSpeed = null;
    state.aligned = null;
    state.cameras = [];
    state.camera = null;
    this.pendingSeek_ns = t_ns;
    this.livePlace_ns = null;
    this.subscribed = '';
    this.saidOfWorld = null;
    this.client?.watch(id);
    this.store.change('run', 'rows', 'log', 'metrics', 'estimators', 'playback');
    this.store.change('pictures', 'scene', 'cameras');
  }

  /** Shows another camera of the run; null = the first. */
  setCamera(name: string | null): void {
    this.store.state.camera = name;
    this.subscribe();
    this.store.change('cameras', 'pictures');
  }

  /** Displayed width of camera and debug images, in device pixels. */
  setPictureWidth(width_px: number): void {
    this.pictureWidth_px = width_px;
    this.subscribe();
  }

  // ---- messages of the stream ------------------------------------------------------------------

  onState(state: ConnectionState): void {
    this.store.state.connection = state;
    this.store.state.wantedSpeed = null;
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
    } else if (message.type === 'estimators') {
      state.statuses = message.estimators;
      this.store.change('estimators');
    } else if (message.type === 'series') {
      state.series = message.series;
      this.store.change('rows');
    } else if (message.type === 'pictures') {
      state.rates = pictureRates(message.pictures);
      this.store.change('pictures');
    } else if (message.type === 'playback') {
      const playback = playbackOf(message, state.runId);
      if (playback !== null) this.onPlayback(playback);
    } else if (message.type === 'error') {
      this.notices.error(message.message);
    }
  }

  onWatchFailed(run: string, message: string): void {
    if (this.store.state.runId === run) this.selectRun(null);
    this.notices.error(`Run ${run} cannot be shown: ${message}`);
  }

  onPicture(name: string, picture: PictureMessage): void {
    this.decoder.push(name, picture);
  }

  onProtocolError(text: string): void {
    this.notices.error(`The server sent an invalid message: ${text}`);
  }

  resume(): Resume {
    return this.store.state.data.resume();
  }

  restore(): ClientMessage[] {
    const { playback, runId } = this.store.state;
    if (playback === null || runId === null) return [];
    const commands: ClientMessage[] = [];
    const { aligned } = this.store.state;
    if (aligned !== null) commands.push({ type: 'align', run: runId, mode: aligned.mode });
    if (playback.speed !== 1) commands.push({ type: 'speed', value: playback.speed });
    if (playback.loop) commands.push({ type: 'loop', value: true });
    this.livePlace_ns = playback.live ? playback.t_ns : null;
    if (!playback.live) {
      commands.push({ type: 'seek', t_ns: playback.t_ns });
      commands.push({ type: playback.playing ? 'play' : 'pause' });
    }
    return commands;
  }

  private onRun(run: Run): void {
    const { state } = this.store;
    state.run = run;
    if (run.world_change !== null && run.world_change !== this.saidOfWorld) {
      this.notices.error(run.world_change);
    }
    this.saidOfWorld = run.world_change;
    const index = state.runs?.findIndex(({ id }) => id === run.id) ?? -1;
    if (state.runs !== null && index >= 0) state.runs[index] = run;
    this.subscribe();
    this.store.change('run', 'lists');
  }

  private onRows(rows: ServerMessage & { type: 'rows' }): void {
    const { state } = this.store;
    if (state.data.apply(rows)) this.store.change(rows.stream === 'log' ? 'log' : 'rows');
    else if (state.runId !== null) {
      this.client?.watch(state.runId);
    }
  }

  private onPlayback(playback: RunPlayback): void {
    const { state } = this.store;
    state.playback = playback;
    if (playback.speed === state.wantedSpeed) state.wantedSpeed = null;
    this.store.change('playback');
    const place_ns = this.livePlace_ns;
    this.livePlace_ns = null;
    if (place_ns !== null && !playback.live) this.command({ type: 'seek', t_ns: place_ns });
    if (this.pendingSeek_ns === null) return;
    const t_ns = this.pendingSeek_ns;
    this.pendingSeek_ns = null;
    this.command({ type: 'seek', t_ns });
    if (playback.playing) this.command({ type: 'pause' });
  }

  private subscribe(): void {
    const { run, runId, camera } = this.store.state;
    if (run === null || runId === null) return;
    const max_width_px = this.pictureWidth_px;
    const pictures: PictureStream[] = [
      { run: runId, name: 'scene', max_hz: 20, quality: 80 },
      {
        run: runId,
        name: 'camera',
        ...(camera === null ? {} : { camera }),
        max_hz: 31,
        quality: 75,
        max_width_px,
      },
      ...run.estimators.map((name) => ({
        run: runId,
        name: `debug/${name}`,
        max_hz: 15,
        quality: 75,
        max_width_px,
      })),
    ];
    const key = JSON.stringify(pictures);
    if (key === this.subscribed) return;
    this.subscribed = key;
    this.client?.subscribe(pictures);
  }

  /** Sends a playback command to the watched run. */
  command(message: ClientMessage): void {
    if (this.store.state.runId !== null) this.client?.command(message);
  }
}
