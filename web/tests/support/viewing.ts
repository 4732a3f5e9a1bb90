// A session on a socket whose other end is the test.
import { StreamClient } from '../../src/connection/stream_client';
import { Notices } from '../../src/store/notices';
import { Player } from '../../src/store/playback/player';
import { SceneControl } from '../../src/store/scene/scene_control';
import { Session } from '../../src/store/session';
import { Store } from '../../src/store/state';
import { FakeSocket, FakeTimers } from './fake_socket';
import { playbackMessage, sampleRun } from './samples';

/** A session that can decode no pictures. */
export function unwatchedSession(store: Store, notices: Notices): Session {
  const noVideo = () => {
    throw new Error('no video here');
  };
  return new Session(
    store,
    notices,
    () => Promise.reject(new Error('no pictures here')),
    noVideo,
    () => 0,
  );
}

export class Viewing {
  readonly store = new Store();
  readonly timers = new FakeTimers();
  readonly session: Session;
  readonly player: Player;
  readonly scene: SceneControl;
  socket = new FakeSocket();

  constructor() {
    const notices = new Notices(this.store, (callback, delay_ms) => {
      this.timers.set(callback, delay_ms);
    });
    this.session = unwatchedSession(this.store, notices);
    const client = new StreamClient({
      open: () => {
        this.socket = new FakeSocket();
        return this.socket;
      },
      timers: this.timers,
      random: () => 0,
      ask: () => undefined,
      listener: this.session,
    });
    this.session.use(client);
    this.player = new Player(this.store, this.session);
    this.scene = new SceneControl(this.store, client);
    client.connect();
    this.socket.hello();
  }

  /** Watches run r1, 63 frames of 31 a second. */
  watch(t_ns: number | null = null): void {
    this.session.showRuns([{ id: 'r1', offset_ns: 0 }], null, t_ns);
    this.socket.receive({ type: 'run', run: sampleRun() });
    const frame = Array.from({ length: 63 }, (_, k) => k);
    const stamps = frame.map((k) => Math.round((k * 1e9) / 31));
    this.socket.receive({
      type: 'rows',
      run: 'r1',
      stream: 'truth',
      seq: 0,
      columns: { frame, t_ns: stamps },
    });
    this.socket.receive(playbackMessage());
  }
}
