// A WebSocket that reconnects by itself. It stores the viewer's settings (runs, pictures, view) and
// sends them again after every reconnection.
import { backoffDelay_ms } from './backoff';
import type {
  Access,
  ClientMessage,
  PictureStream,
  Resume,
  SceneView,
  ServerMessage,
} from '../protocol/messages';
import { kProtocolVersion } from '../protocol/messages';
import type { PictureMessage } from '../protocol/parse';
import { ParseError, parsePicture, parseServerMessage } from '../protocol/parse';

/** The part of WebSocket in use, so that tests need no network. */
export interface Socket {
  binaryType: BinaryType;
  onopen: ((event: Event) => void) | null;
  onmessage: ((event: MessageEvent) => void) | null;
  onclose: ((event: CloseEvent) => void) | null;
  send(text: string): void;
  close(): void;
}

export interface Timers {
  set(callback: () => void, delay_ms: number): number;
  clear(id: number): void;
}

export type ConnectionState =
  | { status: 'connecting'; attempt: number }
  | { status: 'open'; server: string; access: Access }
  /** `reason`: why the server rejected this viewer, if known. */
  | { status: 'waiting'; attempt: number; delay_ms: number; reason?: string }
  /** The server rejects this browser's token: the page must be reloaded. */
  | { status: 'locked' }
  | { status: 'incompatible'; reason: string };

export interface StreamListener {
  onState(state: ConnectionState): void;
  /** Messages of watched runs, and errors; never messages of a run that was left. */
  onMessage(message: ServerMessage): void;
  onWatchFailed(run: string, message: string): void;
  onPicture(run: string, name: string, picture: PictureMessage): void;
  /** Commands that restore the cursor after a reconnection to the same runs. */
  restore(): ClientMessage[];
  /** Rows already received of a watched run, from which the stream resumes. */
  resume(run: string): Resume;
  onProtocolError(text: string): void;
}

export interface StreamClientOptions {
  open: () => Socket;
  timers: Timers;
  random: () => number;
  /**
   * Called when a connection failed to open, to find out the reason; the answer is given by
   * refused() or lock().
   */
  ask: () => void;
  listener: StreamListener;
}

const kCloseTooSlow = 4000;

/** Requests that change neither where the runs are nor the clock. */
const kOfPictures: ReadonlySet<ClientMessage['type']> = new Set(['subscribe', 'key', 'view']);

/** The name under which a stream's pictures arrive. */
export function picturesOf(stream: string, camera?: string, view?: string): string {
  const camera_part = camera === undefined ? '' : `?camera=${camera}`;
  return stream + camera_part + (view === undefined ? '' : `?view=${view}`);
}

export class StreamClient {
  private socket: Socket | null = null;
  private greeted = false;
  private locked = false;
  private waiting: (ConnectionState & { status: 'waiting' }) | null = null;
  private attempt = 0;
  private timer: number | null = null;
  private request = 0;
  /** Number of the newest request that is answered; the server answers in their order. */
  private answered = 0;
  /** Number of the newest request about the runs and the clock; `playback` follows its answer. */
  private placing = 0;
  /** Number of the newest request whose result `playback` has shown. */
  private placed = 0;
  /** The watched runs and their offsets [ns]. */
  private readonly runs = new Map<string, number>();
  /** The run of each unanswered `watch`, by the number of the request. */
  private readonly opening = new Map<number, string>();
  private subscriptions: PictureStream[] = [];
  private view: Partial<SceneView> = {};
  private streams = new Map<number, { run: string; name: string }>();
  /** Newest pictures shown, by stream, that the server does not know about. */
  private readonly unsaid = new Map<number, number>();
  /** Labels of the picture that comes next, by stream. */
  private readonly labels = new Map<number, ServerMessage & { type: 'labels' }>();

  constructor(private readonly options: StreamClientOptions) {}

  /** Whether the server has said what came of every request about the runs and the clock. */
  get settled(): boolean {
    return this.placed >= this.placing;
  }

  /** Connects; if a retry is pending, tries immediately. */
  connect(): void {
    if (this.timer !== null) this.options.timers.clear(this.timer);
    this.timer = null;
    if (this.socket !== null || this.locked) return;
    this.waiting = null;
    this.attempt += 1;
    this.options.listener.onState({ status: 'connecting', attempt: this.attempt });
    const socket = this.options.open();
    this.socket = socket;
    socket.binaryType = 'arraybuffer';
    socket.onmessage = (event) => this.onData(event.data as string | ArrayBuffer);
    socket.onclose = (event) => this.onClosed(socket, event.code);
  }

  /** Stops reconnecting: the server would reject every further attempt of this browser. */
  lock(): void {
    if (this.locked) return;
    this.locked = true;
    this.waiting = null;
    if (this.timer !== null) this.options.timers.clear(this.timer);
    this.timer = null;
    this.drop();
    this.options.listener.onState({ status: 'locked' });
  }

  /** The server answered but rejected this viewer; retries nevertheless. */
  refused(reason: string): void {
    if (this.waiting === null) return;
    this.options.listener.onState({ ...this.waiting, reason });
  }

  /**
   * Watches this run in addition to the others, or again from the rows that are missing.
   * @param offset_ns  time of the clock at the run's beginning
   * @param resume  the rows that are not sent again
   */
  watch(run: string, offset_ns: number, resume = this.options.listener.resume(run)): void {
    this.runs.set(run, offset_ns);
    this.sendWatch(run, offset_ns, resume);
  }

  /** Moves a watched run on the clock. */
  move(run: string, offset_ns: number): void {
    this.runs.set(run, offset_ns);
    this.send({ type: 'watch', run, offset_ns });
  }

  unwatch(run: string): void {
    if (this.runs.delete(run)) this.send({ type: 'unwatch', run });
  }

  subscribe(pictures: PictureStream[]): void {
    this.subscriptions = pictures;
    this.send({ type: 'subscribe', pictures, acknowledge: true });
  }

  /** A picture was shown, or will not be: more may come. */
  shown(stream: number, sequence: number): void {
    if (this.unsaid.size === 0) queueMicrotask(() => this.sayShown());
    this.unsaid.set(stream, Math.max(sequence, this.unsaid.get(stream) ?? 0));
  }

  /** A video picture of a stream was lost: asks for one that does not need it. */
  askForKey(stream: number): void {
    this.send({ type: 'key', id: stream });
  }

  setView(view: Partial<SceneView>): void {
    this.view = { ...this.view, ...view };
    this.send({ type: 'view', ...view });
  }

  /** Sends a playback command; does nothing without a connection. */
  command(message: ClientMessage): void {
    this.send(message);
  }

  /** Without a request number: it needs no answer. */
  private sayShown(): void {
    const pictures = [...this.unsaid];
    this.unsaid.clear();
    if (this.socket === null || !this.greeted) return;
    this.socket.send(JSON.stringify({ type: 'shown', pictures }));
  }

  private send(message: ClientMessage): void {
    if (this.socket === null || !this.greeted) return;
    this.request += 1;
    if (!kOfPictures.has(message.type)) this.placing = this.request;
    this.socket.send(JSON.stringify({ ...message, request: this.request }));
  }

  /** Whether the server has yet to answer that it opens a run. */
  isOpening(run: string): boolean {
    return [...this.opening.values()].includes(run);
  }

  private sendWatch(run: string, offset_ns: number, resume: Resume): void {
    if (this.greeted) this.opening.set(this.request + 1, run);
    const offset = offset_ns === 0 ? {} : { offset_ns };
    this.send({ type: 'watch', run, ...offset, resume });
  }

  private onData(data: string | ArrayBuffer): void {
    try {
      if (typeof data === 'string') this.onText(data);
      else this.onBinary(data);
    } catch (error) {
      if (!(error instanceof ParseError)) throw error;
      this.options.listener.onProtocolError(error.message);
    }
  }

  private onText(text: string): void {
    const message = parseServerMessage(text);
    if (message === null) return;
    if (message.type === 'hello') {
      this.onHello(message);
    } else if (message.type === 'pictures') {
      const own = message.pictures.filter(({ run }) => this.runs.has(run));
      this.streams = new Map(
        own.map(({ id, run, name, camera, view }) => [
          id,
          { run, name: picturesOf(name, camera, view) },
        ]),
      );
      this.options.listener.onMessage({ ...message, pictures: own });
    } else if (message.type === 'labels') {
      this.labels.set(message.id, message);
    } else if (message.type === 'error' && message.picture !== undefined) {
      // It answers no request.
      if (this.runs.has(message.run ?? '')) this.options.listener.onMessage(message);
    } else if (message.type === 'ok' || message.type === 'error') {
      this.onAnswer(message);
    } else if (this.concerns(message)) {
      if (message.type === 'playback') this.placed = this.answered;
      this.options.listener.onMessage(message);
    }
  }

  /** Whether a message is about a watched run; the others are of one that was left. */
  private concerns(
    message: Exclude<ServerMessage, { type: 'hello' | 'ok' | 'error' | 'labels' }>,
  ): boolean {
    if (message.type === 'pictures') return false;
    if (message.type === 'playback')
      return Object.keys(message.runs).some((run) => this.runs.has(run));
    return this.runs.has(message.type === 'run' ? message.run.id : message.run);
  }

  private onAnswer(message: ServerMessage & { type: 'ok' | 'error' }): void {
    const opened = message.request === undefined ? undefined : this.opening.get(message.request);
    if (message.request !== undefined) {
      this.opening.delete(message.request);
      this.answered = message.request;
    }
    if (message.type === 'ok') return;
    // What is refused changes nothing: no `playback` follows.
    this.placed = this.answered;
    if (opened !== undefined && this.runs.delete(opened)) {
      this.options.listener.onWatchFailed(opened, message.message);
    } else {
      this.options.listener.onMessage(message);
    }
  }

  private onHello(message: ServerMessage & { type: 'hello' }): void {
    if (message.protocol !== kProtocolVersion) {
      const reason = `the server uses protocol ${message.protocol}, this page ${kProtocolVersion}: reload the page`;
      this.options.listener.onState({ status: 'incompatible', reason });
      this.drop();
      return;
    }
    this.greeted = true;
    this.attempt = 0;
    const access = message.access === 'viewer' ? 'viewer' : 'operator';
    this.options.listener.onState({ status: 'open', server: message.server, access });
    if (Object.keys(this.view).length > 0) this.send({ type: 'view', ...this.view });
    if (this.runs.size === 0) return;
    for (const [run, offset_ns] of this.runs) this.watch(run, offset_ns);
    if (this.subscriptions.length > 0) {
      this.send({ type: 'subscribe', pictures: this.subscriptions, acknowledge: true });
    }
    for (const command of this.options.listener.restore()) this.send(command);
  }

  private onBinary(buffer: ArrayBuffer): void {
    const picture = parsePicture(buffer);
    const stream = picture === null ? undefined : this.streams.get(picture.streamId);
    if (picture === null) return;
    if (stream === undefined || !this.runs.has(stream.run)) {
      this.shown(picture.streamId, picture.sequence);
      return;
    }
    const labels = this.labels.get(picture.streamId);
    if (labels?.sequence === picture.sequence) picture.labels = labels.labels;
    this.options.listener.onPicture(stream.run, stream.name, picture);
  }

  private onClosed(socket: Socket, code: number): void {
    if (socket !== this.socket) return;
    const refused = !this.greeted;
    this.drop();
    const tooSlow = code === kCloseTooSlow;
    const delay_ms = tooSlow ? 0 : backoffDelay_ms(Math.max(1, this.attempt), this.options.random);
    this.waiting = { status: 'waiting', attempt: this.attempt, delay_ms };
    this.options.listener.onState(this.waiting);
    this.timer = this.options.timers.set(() => this.connect(), delay_ms);
    if (refused) this.options.ask();
  }

  private drop(): void {
    const socket = this.socket;
    this.socket = null;
    this.greeted = false;
    this.answered = this.request;
    this.opening.clear();
    this.streams.clear();
    this.labels.clear();
    this.unsaid.clear();
    if (socket !== null) {
      socket.onclose = null;
      socket.close();
    }
  }
}
