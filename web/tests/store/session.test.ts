import { beforeEach, describe, expect, it } from 'vitest';
import { samplePlayback } from '../support/samples';
import { Viewing } from '../support/viewing';

let viewing: Viewing;

beforeEach(() => {
  viewing = new Viewing();
});

describe('Session', () => {
  it('asks for the pictures of the run, one debug stream an estimator', () => {
    viewing.watch();
    const subscribe = viewing.socket.sent.find(({ type }) => type === 'subscribe');
    expect(subscribe).toMatchObject({
      streams: [{ name: 'scene' }, { name: 'camera' }, { name: 'debug/feature' }],
    });
    expect(viewing.socket.types().filter((type) => type === 'subscribe')).toHaveLength(1);
  });

  it('goes to the instant of a permalink once, and stays there', () => {
    viewing.watch(1.5e9);
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', t_ns: 1.5e9 });
    const sent = viewing.socket.sent.length;
    viewing.socket.receive({ type: 'playback', ...samplePlayback({ t_ns: 1.5e9 }) });
    expect(viewing.socket.sent.length).toBe(sent);
  });

  it('comes back after a lost connection: rows resumed, cursor where it was', () => {
    viewing.watch();
    viewing.socket.receive({ type: 'playback', ...samplePlayback({ t_ns: 1e9, speed: 2 }) });
    viewing.socket.lose();
    expect(viewing.store.state.connection.status).toBe('waiting');
    viewing.timers.fire();
    viewing.socket.hello();
    const attach = viewing.socket.sent.find(({ type }) => type === 'attach');
    expect(attach).toMatchObject({ run: 'r1', resume: { truth: 63 } });
    expect(viewing.socket.types().slice(-3)).toEqual(['speed', 'seek', 'pause']);
  });

  it('asks again for rows when some are missing', () => {
    viewing.watch();
    viewing.socket.receive({ type: 'rows', stream: 'truth', seq: 99, columns: { frame: [99] } });
    expect(viewing.socket.last()).toMatchObject({
      type: 'attach',
      run: 'r1',
      resume: { truth: 63 },
    });
  });

  it('leaves nothing of a run behind when another is chosen', () => {
    viewing.watch();
    viewing.socket.receive({ type: 'metrics', metrics: { estimators: {} } });
    viewing.session.selectRun('r2');
    const { data, metrics, playback, run } = viewing.store.state;
    expect([data.truth.length, metrics, playback, run]).toEqual([0, null, null, null]);
  });

  it('tells when a run cannot be shown', () => {
    viewing.session.selectRun('gone');
    const { request } = viewing.socket.last();
    viewing.socket.receive({ type: 'error', request, code: 'not_found', message: 'no such run' });
    expect(viewing.store.state.runId).toBeNull();
    expect(viewing.store.state.notices[0]?.text).toContain('no such run');
    viewing.timers.fire();
    expect(viewing.store.state.notices).toEqual([]);
  });
});
