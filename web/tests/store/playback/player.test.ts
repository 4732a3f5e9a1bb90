import { beforeEach, describe, expect, it } from 'vitest';

import { playbackMessage } from '../../support/samples';
import { Viewing } from '../../support/viewing';

let viewing: Viewing;

beforeEach(() => {
  viewing = new Viewing();
});

describe('Player', () => {
  it('seeks to the frame nearest to a time', () => {
    viewing.watch();
    viewing.player.seekTime(1e9 + 5e6);
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', frame: 31 });
    viewing.player.seekBy(1e9);
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', frame: 31 });
    viewing.player.seekEdge('end');
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', frame: 62 });
  });

  it('plays and pauses', () => {
    viewing.watch();
    viewing.player.togglePlay();
    expect(viewing.socket.last().type).toBe('play');
    viewing.socket.receive(playbackMessage({ playing: true }));
    viewing.player.togglePlay();
    expect(viewing.socket.last().type).toBe('pause');
  });

  it('seeks by the clock: a run begins at its offset', () => {
    viewing.watch();
    viewing.session.setOffset('r1', 10e9);
    expect(viewing.socket.last()).toMatchObject({ type: 'watch', run: 'r1', offset_ns: 10e9 });
    viewing.player.seekTime(11e9);
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', frame: 31, run: 'r1' });
    viewing.player.seekTime(5e9);
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', t_ns: 5e9 });
    expect(viewing.player.seekTarget_ns(11.01e9)).toBe(11e9);
    expect(viewing.player.seekTarget_ns(5e9)).toBe(5e9);
  });

  it('moves a run on the clock as far as the server takes it', () => {
    viewing.watch();
    viewing.session.setOffset('r1', 1e20);
    expect(viewing.socket.last()).toMatchObject({ run: 'r1', offset_ns: 86_400e9 });
    viewing.session.setOffset('r1', -86_401e9);
    expect(viewing.store.state.offset_ns).toBe(-86_400e9);
  });

  it('goes to the end of the clock, not of the main run', () => {
    viewing.watch();
    viewing.session.addRun('r2');
    viewing.socket.receive(playbackMessage({ end_ns: 2.5e9 }));
    viewing.player.seekEdge('end');
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', t_ns: 2.5e9 });
    viewing.session.setOffset('r1', 0.4e9);
    viewing.player.seekEdge('begin');
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', t_ns: 0 });
    expect(viewing.player.seekTarget_ns(2.5e9)).toBe(2.5e9);
  });

  it('follows any run that flies', () => {
    viewing.watch();
    const sent = viewing.socket.sent.length;
    viewing.player.goLive();
    expect(viewing.socket.sent).toHaveLength(sent);
    viewing.socket.receive(playbackMessage({ flying: true }));
    viewing.player.goLive();
    expect(viewing.socket.last().type).toBe('live');
  });

  it('keeps its direction when the speed changes', () => {
    viewing.watch();
    viewing.player.reverse();
    expect(viewing.socket.last()).toMatchObject({ type: 'speed', value: -1 });
    viewing.player.changeSpeed(1);
    expect(viewing.socket.last()).toMatchObject({ type: 'speed', value: -2 });
    viewing.player.reverse();
    expect(viewing.socket.last()).toMatchObject({ type: 'speed', value: 2 });
  });

  it('sets the ends of a range one after the other', () => {
    viewing.watch();
    viewing.socket.receive(playbackMessage({ t_ns: 5e8 }));
    viewing.player.setRangeEnd('begin');
    expect(viewing.socket.last()).toMatchObject({ type: 'range', begin_ns: 5e8, end_ns: 2e9 });
    const range = { begin_ns: 5e8, end_ns: 2e9 };
    viewing.socket.receive(playbackMessage({ t_ns: 1e9, range }));
    viewing.player.setRangeEnd('end');
    expect(viewing.socket.last()).toMatchObject({ type: 'range', begin_ns: 5e8, end_ns: 1e9 });
    viewing.player.clearRange();
    expect(viewing.socket.last()).not.toHaveProperty('begin_ns');
    expect(viewing.socket.last().type).toBe('range');
  });

  it('forgets a speed that the server has taken back or refused', () => {
    viewing.watch();
    const { socket } = viewing;
    const answer = (type: 'ok' | 'error') => {
      const { request } = socket.last();
      socket.receive({ type, request, code: 'invalid_argument', message: 'no such speed' });
    };
    viewing.player.changeSpeed(1);
    socket.receive(playbackMessage({ live: true, flying: true }));
    expect(viewing.store.state.wantedSpeed).toBe(2);
    answer('ok');
    socket.receive(playbackMessage({ live: true, flying: true }));
    expect(viewing.store.state.wantedSpeed).toBeNull();
    viewing.player.changeSpeed(1);
    expect(socket.last()).toMatchObject({ type: 'speed', value: 2 });
    answer('error');
    expect(viewing.store.state.wantedSpeed).toBeNull();
  });

  it('walks through the speeds without waiting for answers and stops at the limits', () => {
    viewing.watch();
    viewing.player.changeSpeed(1);
    expect(viewing.socket.last()).toMatchObject({ type: 'speed', value: 2 });
    viewing.player.changeSpeed(1);
    expect(viewing.socket.last()).toMatchObject({ type: 'speed', value: 5 });
    viewing.socket.receive(playbackMessage({ speed: 2 }));
    viewing.socket.receive(playbackMessage({ speed: 5 }));
    viewing.socket.receive(playbackMessage({ speed: 0.1 }));
    const sent = viewing.socket.sent.length;
    viewing.player.changeSpeed(-1);
    expect(viewing.socket.sent.length).toBe(sent);
  });
});
