import { beforeEach, describe, expect, it } from 'vitest';
import { StreamClient } from '../../src/connection/stream_client';
import { Notices } from '../../src/store/notices';
import { Session } from '../../src/store/session';
import { Store } from '../../src/store/state';
import { FakeSocket, FakeTimers } from '../support/fake_socket';
import { samplePlayback, sampleRun } from '../support/samples';

let store: Store;
let session: Session;
let timers: FakeTimers;
let socket: FakeSocket;

beforeEach(() => {
  store = new Store();
  timers = new FakeTimers();
  const notices = new Notices(store, (callback, delay_ms) => timers.set(callback, delay_ms));
  session = new Session(store, notices, () => Promise.reject(new Error('no pictures here')));
  const client = new StreamClient({
    open: () => {
      socket = new FakeSocket();
      return socket;
    },
    timers,
    random: () => 0,
    listener: session,
  });
  session.use(client);
  client.connect();
  socket.hello();
});

/** Watches run r1, 63 frames of 31 a second. */
function watch(t_ns: number | null = null): void {
  session.selectRun('r1', t_ns);
  socket.receive({ type: 'run', run: sampleRun() });
  const frame = Array.from({ length: 63 }, (_, k) => k);
  const stamps = frame.map((k) => Math.round((k * 1e9) / 31));
  socket.receive({ type: 'rows', stream: 'truth', seq: 0, columns: { frame, t_ns: stamps } });
  socket.receive({ type: 'playback', ...samplePlayback() });
}

describe('Session', () => {
  it('asks for the pictures of the run, one debug stream an estimator', () => {
    watch();
    const subscribe = socket.sent.find(({ type }) => type === 'subscribe');
    expect(subscribe).toMatchObject({
      streams: [{ name: 'scene' }, { name: 'camera' }, { name: 'debug/feature' }],
    });
    expect(socket.types().filter((type) => type === 'subscribe')).toHaveLength(1);
  });

  it('seeks to the frame nearest to a time', () => {
    watch();
    session.seekTime(1e9 + 5e6);
    expect(socket.last()).toMatchObject({ type: 'seek', frame: 31 });
    session.seekBy(1e9);
    expect(socket.last()).toMatchObject({ type: 'seek', frame: 31 });
    session.seekEdge('end');
    expect(socket.last()).toMatchObject({ type: 'seek', frame: 62 });
  });

  it('goes to the instant of a permalink once, and stays there', () => {
    watch(1.5e9);
    expect(socket.last()).toMatchObject({ type: 'seek', t_ns: 1.5e9 });
    const sent = socket.sent.length;
    socket.receive({ type: 'playback', ...samplePlayback({ t_ns: 1.5e9 }) });
    expect(socket.sent.length).toBe(sent);
  });

  it('plays from the begin again when it stands at the end', () => {
    watch();
    socket.receive({ type: 'playback', ...samplePlayback({ t_ns: 2e9 }) });
    session.togglePlay();
    expect(socket.types().slice(-2)).toEqual(['seek', 'play']);
    socket.receive({ type: 'playback', ...samplePlayback({ playing: true }) });
    session.togglePlay();
    expect(socket.last().type).toBe('pause');
  });

  it('walks through the speeds and stops at the limits', () => {
    watch();
    session.changeSpeed(1);
    expect(socket.last()).toMatchObject({ type: 'speed', value: 2 });
    socket.receive({ type: 'playback', ...samplePlayback({ speed: 0.1 }) });
    const sent = socket.sent.length;
    session.changeSpeed(-1);
    expect(socket.sent.length).toBe(sent);
  });

  it('keeps the viewpoint inside its limits and each mode its own', () => {
    session.orbit({ elevation_deg: 200, distance_m: 1, azimuth_deg: -10 });
    expect(socket.last()).toMatchObject({
      mode: 'chase',
      elevation_deg: 90,
      distance_m: 5,
      azimuth_deg: 350,
    });
    session.setSceneMode('orbit');
    expect(store.state.sceneOrbits.orbit.distance_m).toBeGreaterThan(100);
  });

  it('comes back after a lost connection: rows resumed, cursor where it was', () => {
    watch();
    socket.receive({ type: 'playback', ...samplePlayback({ t_ns: 1e9, speed: 2 }) });
    socket.lose();
    expect(store.state.connection.status).toBe('waiting');
    timers.fire();
    socket.hello();
    const attach = socket.sent.find(({ type }) => type === 'attach');
    expect(attach).toMatchObject({ run: 'r1', resume: { truth: 63 } });
    expect(socket.types().slice(-3)).toEqual(['speed', 'seek', 'pause']);
  });

  it('asks again for rows when some are missing', () => {
    watch();
    socket.receive({ type: 'rows', stream: 'truth', seq: 99, columns: { frame: [99] } });
    expect(socket.last()).toMatchObject({ type: 'attach', run: 'r1', resume: { truth: 63 } });
  });

  it('leaves nothing of a run behind when another is chosen', () => {
    watch();
    socket.receive({ type: 'metrics', metrics: { estimators: {} } });
    session.selectRun('r2');
    const { data, metrics, playback, run } = store.state;
    expect([data.truth.length, metrics, playback, run]).toEqual([0, null, null, null]);
  });

  it('tells when a run cannot be shown', () => {
    session.selectRun('gone');
    const { request } = socket.last();
    socket.receive({ type: 'error', request, code: 'not_found', message: 'no such run' });
    expect(store.state.runId).toBeNull();
    expect(store.state.notices[0]?.text).toContain('no such run');
    timers.fire();
    expect(store.state.notices).toEqual([]);
  });
});
