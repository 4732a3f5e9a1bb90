// Watches runs: requests them and stores what the stream sends about them.
import type { ConnectionState, StreamClient, StreamListener } from '../connection/stream_client';
import type { ClientMessage, PictureStream, Resume, ServerMessage } from '../protocol/messages';
import type { PictureMessage } from '../protocol/parse';
import type { StreamedRun } from '../protocol/rest_types';
import type { ClockSettings } from './playback/clock_settings';
import { kUsualClock, restoringCommands, settingCommands } from './playback/clock_settings';
import type { Notices } from './notices';
import type { Decode } from './pictures/picture_decoder';
import type { OpenVideo } from './pictures/video_decoding';
import type { ShownRun } from './link/permalink';
import { pictureRates } from './pictures/picture_rates';
import { PictureWishes } from './pictures/picture_wishes';
import { RunPictures } from './pictures/run_pictures';
import { clockOf } from './playback/run_playback';
import { shownAlignment } from './state';
import type { State, Store } from './state';
import { kMostOffset_ns, kMostRuns, WatchedRun } from './watched_run';

const kNothingSubscribed = '[]';

export class Session implements StreamListener {
  private client: StreamClient | null = null;
  /** Where and how to begin when the server has sent where all runs are. */
  private pending: { t_ns: number | null; settings: ClockSettings | null } | null = null;
  /** Position of a live viewer when the connection was lost, until all runs are there again. */
  private livePlace_ns: number | null = null;
  private readonly wishes = new PictureWishes();
  private readonly pictures: RunPictures;
  /** A page that is not on the screen needs no pictures. */
  private pageShown = true;
  private video = false;
  private subscribed = kNothingSubscribed;
  /** The latest message about the world of each run. */
  private readonly saidOfWorld = new Map<string, string | null>();
  private readonly state: State;

  constructor(
    private readonly store: Store,
    private readonly notices: Notices,
    decode: Decode,
    openVideo: OpenVideo,
    now_ms: () => number,
  ) {
    this.state = store.state;
    const answers = {
      settled: (streamId: number, sequence: number) => this.client?.shown(streamId, sequence),
      lost: (streamId: number) => this.client?.askForKey(streamId),
      videoFailed: () => this.useVideo(false),
    };
    const { wishes } = this;
    this.pictures = new RunPictures(store, notices, wishes, decode, openVideo, answers, now_ms);
  }

  use(client: StreamClient): void {
    this.client = client;
  }

  /** Whether runs and clock are where the viewer wants them. */
  get settled(): boolean {
    return this.pending === null && this.client?.settled !== false;
  }

  // ---- commands of the viewer ------------------------------------------------------------------

  /** Shows a run: one that is watched already becomes the main one, another replaces all. */
  selectRun(id: string | null): void {
    if (id !== null && this.state.watchedRun(id) !== undefined) this.makeMain(id);
    else this.showRuns(id === null ? [] : [{ id, offset_ns: 0 }], null, null);
  }

  /**
   * Shows exactly these runs, in this order.
   * @param main  null = the first
   * @param t_ns  of the clock; null = where it is, or the server's default position
   * @param settings  of the clock; null = as they are
   */
  showRuns(
    runs: readonly ShownRun[],
    main: string | null,
    t_ns: number | null,
    settings: ClockSettings | null = null,
  ): void {
    const { state } = this;
    const left = state.watched.filter(({ id }) => !runs.some((run) => run.id === id));
    for (const { id } of left) this.leave(id);
    if (state.watched.length === 0) {
      state.clock = null;
      state.wantedSpeed = null;
      this.livePlace_ns = null;
      this.pending = null;
    }
    const added = runs.filter(({ id }) => state.watchedRun(id) === undefined);
    for (const { id, offset_ns } of runs) this.setOffset(id, offset_ns);
    for (const { id, offset_ns } of added) this.watch(id, offset_ns);
    state.watched = runs.flatMap(({ id }) => state.watchedRun(id) ?? []);
    state.main = (main === null ? undefined : state.watchedRun(main)) ?? state.watched[0] ?? null;
    this.setClock(t_ns, settings, added.length > 0);
    this.subscribe();
    this.changedRuns();
  }

  /** Waits for a connection, and for added runs: without them the time is limited to the others. */
  private setClock(t_ns: number | null, settings: ClockSettings | null, added: boolean): void {
    if (added || this.pending !== null || this.state.connection.status !== 'open') {
      const before = this.pending ?? { t_ns: null, settings: null };
      this.pending = { t_ns: t_ns ?? before.t_ns, settings: settings ?? before.settings };
      return;
    }
    const { clock } = this.state;
    const now = clock ?? kUsualClock;
    for (const command of settingCommands(settings ?? now, now)) this.command(command);
    if (t_ns === null) return;
    this.command({ type: 'seek', t_ns });
    if (clock?.playing === true) this.command({ type: 'pause' });
  }

  /** Shows a run together with those that are watched. */
  addRun(id: string, offset_ns = 0): void {
    const { watched } = this.state;
    if (this.state.watchedRun(id) !== undefined) return;
    if (watched.length >= kMostRuns) {
      this.notices.error(`Not more than ${kMostRuns} runs can be shown together.`);
      return;
    }
    this.watch(id, offset_ns);
    this.subscribe();
    this.changedRuns();
  }

  /** Stops showing a run; the others stay. */
  removeRun(id: string): void {
    if (this.state.watchedRun(id) === undefined) return;
    if (this.state.watched.length === 1) {
      this.selectRun(null);
      return;
    }
    this.leave(id);
    this.begin();
    this.subscribe();
    this.changedRuns();
  }

  /** Shows pictures, timeline and details of one of the watched runs. */
  makeMain(id: string): void {
    const watched = this.state.watchedRun(id);
    if (watched === undefined || watched === this.state.main) return;
    this.state.main = watched;
    this.subscribe();
    this.changedRuns();
  }

  /** Moves a run on the clock. @param wanted_ns  at most a day is taken */
  setOffset(id: string, wanted_ns: number): void {
    const offset_ns = Math.min(kMostOffset_ns, Math.max(-kMostOffset_ns, wanted_ns));
    const watched = this.state.watchedRun(id);
    if (watched === undefined || watched.offset_ns === offset_ns) return;
    watched.offset_ns = offset_ns;
    this.client?.move(id, offset_ns);
    this.store.change('run', 'rows', 'playback');
  }

  /** Reads a run again that another process writes. @param whole  with the rows that have come */
  readAgain(id: string, whole: boolean): void {
    const offset_ns = this.state.watchedRun(id)?.offset_ns;
    if (this.client?.isOpening(id) === true) return;
    if (offset_ns !== undefined) this.client?.watch(id, offset_ns, whole ? {} : this.resume(id));
  }

  /** Shows or hides a track in the plots. @param name  of the estimator; '' = the truth */
  showTrack(id: string, name: string, shown: boolean): void {
    const watched = this.state.watchedRun(id);
    if (watched === undefined) return;
    const hidden = new Set(watched.hidden);
    if (shown) hidden.delete(name);
    else hidden.add(name);
    watched.hidden = hidden;
    this.store.change('run', 'rows');
  }

  /** Shows another camera of the main run; null = the first. */
  setCamera(name: string | null): void {
    const { main } = this.state;
    if (main === null) return;
    main.camera = name;
    this.subscribe();
    this.store.change('cameras', 'pictures');
  }

  /** Shows the pictures of all watched runs side by side, or only those of the main one. */
  setSideBySide(sideBySide: boolean): void {
    if (this.state.sideBySide === sideBySide) return;
    this.state.sideBySide = sideBySide;
    this.store.change('run', 'pictures');
  }

  /** Replaces the pictures that a panel needs; none when it is hidden. */
  want(panel: string, streams: readonly PictureStream[]): void {
    this.wishes.set(panel, streams);
    this.subscribe();
  }

  /** Whether pictures may come as video, which the browser must be able to decode. */
  useVideo(video: boolean): void {
    this.video = video;
    this.subscribe();
  }

  /** Whether the page can be seen: no pictures are sent to one that is behind others. */
  showPage(shown: boolean): void {
    this.pageShown = shown;
    this.subscribe();
  }

  /** Sends a command about the watched runs. */
  command(message: ClientMessage): void {
    if (this.state.main !== null) this.client?.command(message);
  }

  // ---- messages of the stream ------------------------------------------------------------------

  onState(state: ConnectionState): void {
    this.state.connection = state;
    this.state.wantedSpeed = null;
    if (state.status === 'open') {
      this.subscribed = kNothingSubscribed;
      this.pictures.clear();
      this.store.setAccess(state.access);
    }
    this.store.change('connection');
  }

  onMessage(message: ServerMessage): void {
    if (message.type === 'error') {
      this.pictures.refuse(message);
      this.forgetSpeed();
    } else if (message.type === 'playback') this.onPlayback(message);
    else if (message.type === 'pictures') this.onPictures(message);
    else if (message.type === 'run') this.onRun(message.run);
    else if ('run' in message) this.onRunData(message);
  }

  onWatchFailed(run: string, message: string): void {
    if (this.state.watchedRun(run) !== undefined) this.removeRun(run);
    this.notices.error(`Run ${run} cannot be shown: ${message}`);
  }

  onPicture(run: string, name: string, picture: PictureMessage): void {
    this.pictures.take(run, name, picture);
  }

  onProtocolError(text: string): void {
    this.notices.error(`The server sent an invalid message: ${text}`);
  }

  resume(run: string): Resume {
    return this.state.watchedRun(run)?.data.resume() ?? {};
  }

  restore(): ClientMessage[] {
    const { clock, watched } = this.state;
    if (clock === null) return [];
    const commands = watched
      .filter(({ aligned }) => aligned !== null)
      .map((one): ClientMessage => ({ type: 'align', run: one.id, mode: shownAlignment(one) }));
    if (clock.live) this.livePlace_ns = clock.t_ns;
    return [...commands, ...restoringCommands(clock)];
  }

  // ---- the watched runs ------------------------------------------------------------------------

  private watch(id: string, offset_ns: number): void {
    const { state } = this;
    const watched = new WatchedRun(id);
    watched.run = state.runs?.find((run) => run.id === id) ?? null;
    watched.offset_ns = offset_ns;
    state.watched.push(watched);
    state.plotWindow = null;
    state.main ??= watched;
    this.pictures.watch(watched);
    this.client?.watch(id, offset_ns);
  }

  private leave(id: string): void {
    const { state } = this;
    const watched = state.watchedRun(id);
    if (watched === undefined) return;
    this.client?.unwatch(id);
    this.pictures.leave(watched);
    this.saidOfWorld.delete(id);
    state.watched.splice(state.watched.indexOf(watched), 1);
    state.plotWindow = null;
    if (state.main === watched) state.main = state.watched[0] ?? null;
    if (state.main === null) this.subscribed = kNothingSubscribed;
  }

  private changedRuns(): void {
    this.store.change('run', 'rows', 'log', 'metrics', 'estimators', 'playback');
    this.store.change('pictures', 'scene', 'cameras');
  }

  private onPictures(message: ServerMessage & { type: 'pictures' }): void {
    for (const watched of this.state.watched) {
      watched.rates = pictureRates(message.pictures.filter(({ run }) => run === watched.id));
    }
    this.state.reduction = message.reduction ?? 0;
    this.store.change('pictures');
  }

  private onRun(streamed: StreamedRun): void {
    const { state } = this;
    const watched = state.watchedRun(streamed.id);
    if (watched === undefined) return;
    const index = state.runs?.findIndex(({ id }) => id === streamed.id) ?? -1;
    const known = state.runs?.[index] ?? watched.run ?? { results: [], tags: [], note: '' };
    const run = { results: known.results, tags: known.tags, note: known.note, ...streamed };
    watched.run = run;
    const { world_change } = run;
    if (world_change !== null && world_change !== this.saidOfWorld.get(run.id)) {
      this.notices.error(world_change);
    }
    this.saidOfWorld.set(run.id, world_change);
    if (state.runs !== null && index >= 0) state.runs[index] = run;
    this.subscribe();
    this.store.change('run', 'lists');
  }

  private onRunData(
    message: ServerMessage & { type: 'rows' | 'metrics' | 'estimators' | 'series' },
  ): void {
    const watched = this.state.watchedRun(message.run);
    if (watched === undefined) return;
    if (message.type === 'metrics') {
      watched.metrics = message.metrics;
      this.store.change('metrics');
    } else if (message.type === 'estimators') {
      watched.statuses = message.estimators;
      this.store.change('estimators');
    } else if (message.type === 'series') {
      watched.series = message.series;
      this.store.change('rows');
    } else if (watched.data.apply(message)) {
      this.store.change(message.stream === 'log' ? 'log' : 'rows');
    } else {
      this.client?.watch(watched.id, watched.offset_ns);
    }
  }

  private onPlayback(message: ServerMessage & { type: 'playback' }): void {
    const { state } = this;
    const clock = clockOf(message);
    state.clock = clock;
    for (const watched of state.watched) watched.instant = message.runs[watched.id] ?? null;
    this.forgetSpeed();
    this.store.change('playback');
    if (clock.live) this.livePlace_ns = null;
    this.begin();
  }

  /** It was confirmed, refused, or changed again by the server, as it is at the end of a live flight. */
  private forgetSpeed(): void {
    const { state } = this;
    const confirmed = state.clock?.speed === state.wantedSpeed;
    if (confirmed || this.client?.settled === true) state.wantedSpeed = null;
  }

  /** Once all runs are there. */
  private begin(): void {
    const { clock, watched } = this.state;
    if (clock === null) return;
    if (watched.some(({ instant }) => instant === null)) return;
    const { livePlace_ns, pending } = this;
    this.livePlace_ns = null;
    this.pending = null;
    if (livePlace_ns !== null) {
      this.command(clock.flying ? { type: 'live' } : { type: 'seek', t_ns: livePlace_ns });
    }
    if (pending === null) return;
    const { t_ns, settings } = pending;
    for (const command of settingCommands(settings ?? clock, clock)) this.command(command);
    if (t_ns === null) return;
    this.command({ type: 'seek', t_ns });
    if (clock.playing) this.command({ type: 'pause' });
  }

  private subscribe(): void {
    const { main } = this.state;
    if (main === null) return;
    const wanted = this.pageShown ? this.wishes.union() : [];
    const encoding = this.video ? ({ encoding: 'vp8' } as const) : {};
    const pictures = wanted
      .filter(({ run }) => this.state.watchedRun(run) !== undefined)
      .map((stream) => ({ ...encoding, ...stream }));
    const key = JSON.stringify(pictures);
    if (key === this.subscribed) return;
    this.subscribed = key;
    this.client?.subscribe(pictures);
  }
}
