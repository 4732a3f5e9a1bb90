import { beforeEach, describe, expect, it } from 'vitest';

import { rateBadge } from '../../src/store/pictures/picture_rates';
import { kTopics } from '../../src/store/state';
import { playbackMessage, samplePlayback, sampleRun, sampleStatus } from '../support/samples';
import { Viewing } from '../support/viewing';

let viewing: Viewing;

beforeEach(() => {
  viewing = new Viewing();
});

describe('Session', () => {
  it('asks for the pictures that panels on the screen need, and for no others', () => {
    viewing.watch();
    const { session, socket } = viewing;
    expect(socket.types()).not.toContain('subscribe');
    const camera = { run: 'r1', name: 'camera', max_hz: 31, max_width_px: 640 };
    session.want('camera', [camera]);
    session.want('large', [{ ...camera, max_width_px: 1280 }]);
    session.want('scene', [{ run: 'r1', name: 'scene' }]);
    session.want('debug', [{ run: 'other', name: 'debug/feature' }]);
    const all = [
      { ...camera, max_width_px: 1280 },
      { run: 'r1', name: 'scene' },
    ];
    expect(socket.last()).toMatchObject({ type: 'subscribe', pictures: all });
    session.want('large', []);
    session.want('scene', []);
    expect(socket.last()).toMatchObject({ type: 'subscribe', pictures: [camera] });
    const sent = socket.sent.length;
    session.want('camera', [camera]);
    expect(socket.sent).toHaveLength(sent);
  });

  it('asks for no pictures while the page is not on the screen', () => {
    viewing.watch();
    const { session, socket } = viewing;
    session.want('scene', [{ run: 'r1', name: 'scene' }]);
    session.showPage(false);
    expect(socket.last()).toMatchObject({ type: 'subscribe', pictures: [] });
    session.showPage(true);
    expect(socket.last()).toMatchObject({ pictures: [{ run: 'r1', name: 'scene' }] });
  });

  it('goes to the instant of a permalink once, and stays there', () => {
    viewing.watch(1.5e9);
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', t_ns: 1.5e9 });
    const sent = viewing.socket.sent.length;
    viewing.socket.receive(playbackMessage({ t_ns: 1.5e9 }));
    expect(viewing.socket.sent.length).toBe(sent);
  });

  it('plays as a permalink says, once all of its runs are there', () => {
    const { session, socket, store } = viewing;
    const settings = { range: { begin_ns: 1e9, end_ns: 2e9 }, speed: -2, loop: true };
    const runs = ['r1', 'r2'].map((id) => ({ id, offset_ns: 0 }));
    session.showRuns(runs, null, 1.5e9, settings);
    const before = socket.sent.length;
    socket.receive(playbackMessage());
    expect(socket.sent.length, 'r2 is not there').toBe(before);
    const both = playbackMessage({ playing: true });
    socket.receive({ ...both, runs: { ...both.runs, ...playbackMessage({}, 'r2').runs } });
    expect(socket.sent.slice(before)).toMatchObject([
      { type: 'speed', value: -2 },
      { type: 'loop', value: true },
      { type: 'range', begin_ns: 1e9, end_ns: 2e9 },
      { type: 'seek', t_ns: 1.5e9 },
      { type: 'pause' },
    ]);
    store.state.clock = { ...samplePlayback(), ...settings };
    session.showRuns(runs, null, null, { range: null, speed: -2, loop: true });
    expect(socket.last()).toMatchObject({ type: 'range' });
    expect(socket.last()).not.toHaveProperty('begin_ns');
  });

  it('follows the last of two permalinks that are opened before their runs are there', () => {
    const { session, socket } = viewing;
    const settings = { range: null, speed: 2, loop: false };
    session.showRuns([{ id: 'r1', offset_ns: 0 }], null, 1.5e9, settings);
    session.showRuns([{ id: 'r1', offset_ns: 0 }], null, 0.5e9);
    const before = socket.sent.length;
    socket.receive(playbackMessage());
    expect(socket.sent.slice(before)).toMatchObject([
      { type: 'speed', value: 2 },
      { type: 'seek', t_ns: 0.5e9 },
    ]);
    expect(socket.types().filter((type) => type === 'seek')).toHaveLength(1);
  });

  it('goes to the instant of a permalink without the run that cannot be shown', () => {
    const { session, socket } = viewing;
    const runs = ['r1', 'r2'].map((id) => ({ id, offset_ns: 0 }));
    session.showRuns(runs, null, 1.5e9);
    socket.receive(playbackMessage());
    expect(socket.types()).not.toContain('seek');
    session.onWatchFailed('r2', 'there is none');
    expect(socket.sent.at(-1)).toMatchObject({ type: 'seek', t_ns: 1.5e9 });
  });

  it('comes back after a lost connection: rows resumed, cursor where it was', () => {
    viewing.watch();
    viewing.socket.receive(playbackMessage({ t_ns: 1e9, speed: 2 }));
    viewing.socket.lose();
    expect(viewing.store.state.connection.status).toBe('waiting');
    viewing.timers.fire();
    viewing.socket.hello();
    const watch = viewing.socket.sent.find(({ type }) => type === 'watch');
    expect(watch).toMatchObject({ run: 'r1', resume: { truth: 63 } });
    expect(viewing.socket.types().slice(-3)).toEqual(['speed', 'seek', 'pause']);
  });

  it('follows what the server lets it do, which stays while the connection is lost', () => {
    const { state } = viewing.store;
    expect(state.mayChange).toBe(true);
    viewing.socket.lose();
    viewing.timers.fire();
    viewing.store.take();
    viewing.socket.hello(2, 'viewer');
    expect(state).toMatchObject({ access: 'viewer', mayChange: false });
    expect(viewing.store.take()).toEqual(kTopics);
    viewing.socket.lose();
    expect(state.access).toBe('viewer');
    viewing.timers.fire();
    viewing.socket.hello(2, 'operator');
    expect(state).toMatchObject({ access: 'operator', mayChange: true });
  });

  it('keeps the place of a live viewer whose run ended while the connection was lost', () => {
    const { session, socket } = viewing;
    session.selectRun('r1');
    socket.receive({ type: 'run', run: sampleRun({ status: 'running' }) });
    const live = samplePlayback({ t_ns: 1.2e9, live: true, playing: true });
    socket.receive(playbackMessage(live));
    socket.lose();
    viewing.timers.fire();
    viewing.socket.hello();
    viewing.socket.receive({ type: 'run', run: sampleRun() });
    expect(viewing.socket.types()).not.toContain('seek');
    viewing.socket.receive(playbackMessage());
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', t_ns: 1.2e9 });
  });

  it('stays live after a lost connection while the run goes on', () => {
    viewing.session.selectRun('r1');
    viewing.socket.receive({ type: 'run', run: sampleRun({ status: 'running' }) });
    const live = samplePlayback({ t_ns: 1.2e9, live: true, playing: true });
    viewing.socket.receive(playbackMessage(live));
    viewing.socket.lose();
    viewing.timers.fire();
    viewing.socket.hello();
    viewing.socket.receive({ type: 'run', run: sampleRun({ status: 'running' }) });
    viewing.socket.receive(playbackMessage({ live: true, t_ns: 1.5e9 }));
    expect(viewing.socket.types()).not.toContain('seek');
  });

  /** Of an ended run r1, watched first, and of r2. */
  const bothRuns = (change: Parameters<typeof samplePlayback>[0]) => {
    const both = playbackMessage(change);
    return { ...both, runs: { ...both.runs, ...playbackMessage(change, 'r2').runs } };
  };

  it.each([
    ['stays live', true, { type: 'live' }],
    ['keeps the place', false, { type: 'seek', t_ns: 1.2e9 }],
  ])(
    '%s in a comparison once all runs are there again, even if the connection is lost twice',
    (_, flying, command) => {
      viewing.watch();
      viewing.session.addRun('r2');
      viewing.socket.receive(bothRuns({ t_ns: 1.2e9, live: true, playing: true, flying: true }));
      for (let lost = 0; lost < 2; lost += 1) {
        viewing.socket.lose();
        viewing.timers.fire();
        viewing.socket.hello();
        viewing.socket.receive(playbackMessage());
        expect(viewing.socket.types()).not.toContain('live');
      }
      const { socket } = viewing;
      const sent = socket.sent.length;
      socket.receive(bothRuns({ flying }));
      expect(socket.sent.slice(sent)).toMatchObject([command]);
      socket.receive(bothRuns({ flying }));
      expect(socket.sent).toHaveLength(sent + 1);
    },
  );

  it('goes to the instant of a second link once the runs that it adds are there', () => {
    viewing.watch();
    const { session, socket } = viewing;
    const sent = socket.sent.length;
    const settings = { range: null, speed: 2, loop: false };
    const added = { id: 'r2', offset_ns: 9e9 };
    session.showRuns([{ id: 'r1', offset_ns: 0 }, added], null, 9.5e9, settings);
    socket.receive(playbackMessage());
    expect(socket.sent.slice(sent)).toMatchObject([{ type: 'watch', run: 'r2' }]);
    socket.receive(bothRuns({}));
    expect(socket.sent.slice(sent + 1)).toMatchObject([
      { type: 'speed', value: 2 },
      { type: 'seek', t_ns: 9.5e9 },
    ]);
  });

  it('moves the runs of a second link before it goes to its instant', () => {
    viewing.watch();
    const sent = viewing.socket.sent.length;
    viewing.session.showRuns([{ id: 'r1', offset_ns: 9e9 }], null, 9.5e9);
    expect(viewing.socket.sent.slice(sent)).toMatchObject([
      { type: 'watch', run: 'r1', offset_ns: 9e9 },
      { type: 'seek', t_ns: 9.5e9 },
    ]);
  });

  it('keeps the status of the estimators until another run is watched', () => {
    viewing.watch();
    const estimators = { feature: sampleStatus({ dropped: 7 }) };
    viewing.socket.receive({ type: 'estimators', run: 'r1', estimators });
    expect(viewing.store.state.statuses['feature']?.dropped).toBe(7);
    expect(viewing.store.take().has('estimators')).toBe(true);
    viewing.session.selectRun('r2');
    expect(viewing.store.state.statuses).toEqual({});
  });

  it('knows which pictures come more slowly than they were asked for', () => {
    viewing.watch();
    const pictures = [
      { id: 1, run: 'r1', name: 'scene', max_hz: 20, limit_hz: 5 },
      { id: 2, run: 'r1', name: 'camera', camera: 'left', max_hz: 31, limit_hz: 5 },
      { id: 3, run: 'r1', name: 'debug/feature', max_hz: 4, limit_hz: 4 },
    ];
    viewing.socket.receive({ type: 'pictures', pictures });
    const { rates } = viewing.store.state;
    expect([...rates.keys()]).toEqual(['scene', 'camera?camera=left']);
    expect(rateBadge(null, rates.get('camera?camera=left'), 0)).toMatchObject({
      text: '5/31 Hz',
      reduced: true,
    });
    expect(rateBadge(null, rates.get('debug/feature'), 0).text).toBe('');
    viewing.socket.receive({ type: 'pictures', pictures: [{ id: 1, run: 'r1', name: 'scene' }] });
    expect(viewing.store.state.rates.size).toBe(0);
  });

  it('asks again for rows when some are missing', () => {
    viewing.watch();
    viewing.socket.receive({
      type: 'rows',
      run: 'r1',
      stream: 'truth',
      seq: 99,
      columns: { frame: [99] },
    });
    expect(viewing.socket.last()).toMatchObject({
      type: 'watch',
      run: 'r1',
      resume: { truth: 63 },
    });
  });

  it('leaves nothing of a run behind when another is chosen', () => {
    viewing.watch();
    viewing.socket.receive({ type: 'metrics', run: 'r1', metrics: { estimators: {} } });
    viewing.session.selectRun('r2');
    const { data, metrics, playback, run } = viewing.store.state;
    expect([data.truth.length, metrics, playback, run]).toEqual([0, null, null, null]);
  });

  it('reports once that the terrain has changed since the run was flown', () => {
    viewing.watch();
    const texts = () => viewing.store.state.notices.map(({ text }) => text);
    expect(texts()).toEqual([]);
    const world_change = 'ortho.tif has changed since this run was flown';
    viewing.socket.receive({ type: 'run', run: sampleRun({ world_change }) });
    viewing.socket.receive({ type: 'run', run: sampleRun({ world_change }) });
    expect(texts()).toEqual([world_change]);
    viewing.timers.fire();
    viewing.socket.receive({ type: 'run', run: sampleRun({ world_change }) });
    expect(texts()).toEqual([]);
    viewing.session.selectRun('r2');
    viewing.socket.receive({ type: 'run', run: sampleRun({ id: 'r2', world_change }) });
    expect(texts()).toEqual([world_change]);
  });

  it('keeps what only the list has of a run: results, tags and note', () => {
    const results = [
      { estimator: 'x', outcome: 'LOST', position_rmse_m: 2, position_rmse_percent: 1 },
    ];
    const listed = sampleRun({ results, tags: ['wind'], note: 'again' });
    viewing.watch();
    viewing.store.state.runs = [listed];
    const streamed = Object.entries(sampleRun({ frames: 7 })).filter(
      ([name]) => !['results', 'tags', 'note'].includes(name),
    );
    viewing.socket.receive({ type: 'run', run: Object.fromEntries(streamed) });
    expect(viewing.store.state.runs[0]).toEqual({ ...listed, frames: 7 });
    expect(viewing.store.state.run).toEqual({ ...listed, frames: 7 });
  });

  it('reports a run that cannot be shown', () => {
    viewing.session.selectRun('gone');
    const { request } = viewing.socket.last();
    viewing.socket.receive({ type: 'error', request, code: 'not_found', message: 'no such run' });
    expect(viewing.store.state.runId).toBeNull();
    expect(viewing.store.state.notices[0]?.text).toContain('no such run');
    viewing.timers.fire();
    expect(viewing.store.state.notices).toEqual([]);
  });

  it('shows several runs on one clock, each with its own rows and pictures', () => {
    viewing.watch();
    viewing.session.addRun('r2', 2e9);
    expect(viewing.socket.sent).toContainEqual(
      expect.objectContaining({ type: 'watch', run: 'r2', offset_ns: 2e9 }),
    );
    viewing.socket.receive({ type: 'run', run: sampleRun({ id: 'r2', title: 'Second' }) });
    const rows = { stream: 'truth', seq: 0, columns: { frame: [0], t_ns: [0] } };
    viewing.socket.receive({ type: 'rows', run: 'r2', ...rows });
    const { state } = viewing.store;
    expect(state.watched.map(({ id, data }) => [id, data.truth.length])).toEqual([
      ['r1', 63],
      ['r2', 1],
    ]);
    expect(state.runId).toBe('r1');
    viewing.session.selectRun('r2');
    expect(state.runId).toBe('r2');
    expect(state.watched).toHaveLength(2);
  });

  it('leaves one of several runs: the others stay', () => {
    viewing.watch();
    viewing.session.addRun('r2');
    viewing.socket.receive({ type: 'run', run: sampleRun({ id: 'r2' }) });
    viewing.session.removeRun('r1');
    expect(viewing.socket.types()).toContain('unwatch');
    expect(viewing.store.state.runId).toBe('r2');
    viewing.session.removeRun('r2');
    expect(viewing.store.state.watched).toEqual([]);
    expect(viewing.store.state.main).toBeNull();
  });

  it('goes from one set of runs to another without watching again what stays', () => {
    viewing.watch();
    viewing.session.showRuns(
      [
        { id: 'r3', offset_ns: 0 },
        { id: 'r1', offset_ns: 1e9 },
      ],
      'r1',
      null,
    );
    const { state } = viewing.store;
    expect(state.watched.map(({ id }) => id)).toEqual(['r3', 'r1']);
    expect(state.runId).toBe('r1');
    expect(state.data.truth.length).toBe(63);
    expect(state.offset_ns).toBe(1e9);
  });

  it('watches all runs again after a lost connection', () => {
    viewing.watch();
    viewing.session.addRun('r2', 3e9);
    viewing.socket.lose();
    viewing.timers.fire();
    viewing.socket.hello();
    const watches = viewing.socket.sent.filter(({ type }) => type === 'watch');
    expect(watches).toMatchObject([
      { run: 'r1', resume: { truth: 63 } },
      { run: 'r2', offset_ns: 3e9, resume: {} },
    ]);
  });

  it('refuses more runs than the server permits', () => {
    viewing.watch();
    for (let i = 2; i <= 17; i += 1) viewing.session.addRun(`r${i}`);
    expect(viewing.store.state.watched).toHaveLength(16);
    expect(viewing.store.state.notices[0]?.text).toContain('16');
  });
});
