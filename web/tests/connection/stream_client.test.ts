import { beforeEach, describe, expect, it } from 'vitest';
import type { ConnectionState, StreamListener } from '../../src/connection/stream_client';
import { StreamClient } from '../../src/connection/stream_client';
import type { ClientMessage, Resume, ServerMessage } from '../../src/protocol/messages';
import { encodePicture, sampleHeader } from '../support/encode_picture';
import { FakeSocket, FakeTimers } from '../support/fake_socket';
import { playbackMessage, sampleRun } from '../support/samples';

class Listener implements StreamListener {
  states: ConnectionState[] = [];
  messages: ServerMessage[] = [];
  pictures: string[] = [];
  protocolErrors: string[] = [];
  failed: string[] = [];
  rows: Resume = {};
  commands: ClientMessage[] = [];
  onState = (state: ConnectionState) => this.states.push(state);
  onMessage = (message: ServerMessage) => this.messages.push(message);
  onWatchFailed = (run: string, message: string) => this.failed.push(`${run}: ${message}`);
  onPicture = (run: string, name: string) => this.pictures.push(`${run} ${name}`);
  onProtocolError = (text: string) => this.protocolErrors.push(text);
  resume = () => this.rows;
  restore = () => this.commands;
}

let sockets: FakeSocket[];
let timers: FakeTimers;
let listener: Listener;
let client: StreamClient;
let asked: number;

function socket(): FakeSocket {
  const newest = sockets.at(-1);
  if (newest === undefined) throw new Error('no socket was opened');
  return newest;
}

function picture(streamId: number): ArrayBuffer {
  return encodePicture(sampleHeader({ streamId }), Uint8Array.of(1));
}

beforeEach(() => {
  sockets = [];
  asked = 0;
  timers = new FakeTimers();
  listener = new Listener();
  client = new StreamClient({
    open: () => {
      const opened = new FakeSocket();
      sockets.push(opened);
      return opened;
    },
    timers,
    random: () => 0,
    ask: () => (asked += 1),
    listener,
  });
});

function watching(run = 'r1'): void {
  client.connect();
  socket().hello();
  client.watch(run, 0);
  socket().receive({ type: 'ok', request: socket().last().request });
  socket().receive({ type: 'run', run: sampleRun({ id: run }) });
}

describe('StreamClient', () => {
  it('says nothing before the server has greeted, then all that is wanted', () => {
    client.connect();
    client.watch('r1', 0);
    client.subscribe([{ run: 'r1', name: 'camera' }]);
    client.setView({ mode: 'top' });
    expect(socket().sent).toEqual([]);
    socket().hello();
    expect(socket().types()).toEqual(['view', 'watch', 'subscribe']);
    expect(listener.states.at(-1)).toMatchObject({ status: 'open', server: 'overfly 0.1.0' });
  });

  it.each([
    ['viewer', 'viewer'],
    ['operator', 'operator'],
    [undefined, 'operator'],
  ])('of a server that says %s has the access %s', (said, access) => {
    client.connect();
    socket().hello(2, said);
    expect(listener.states.at(-1)).toMatchObject({ status: 'open', access });
  });

  it('refuses a server of another protocol and does not come back', () => {
    client.connect();
    socket().hello(3);
    expect(listener.states.at(-1)?.status).toBe('incompatible');
    expect(socket().closed).toBe(true);
    expect(timers.waiting.size).toBe(0);
  });

  it('waits longer after each attempt, and starts again after a success', () => {
    client.connect();
    const delays: number[] = [];
    for (let i = 0; i < 6; i += 1) {
      socket().lose();
      delays.push(...timers.delays());
      timers.fire();
    }
    expect(delays).toEqual([500, 1000, 2000, 4000, 8000, 8000]);
    socket().hello();
    socket().lose();
    expect(timers.delays()).toEqual([500]);
  });

  it('asks for the reason of a rejection once for each attempt that failed to open', () => {
    client.connect();
    socket().lose();
    expect(asked).toBe(1);
    timers.fire();
    socket().hello();
    socket().lose();
    expect(asked).toBe(1);
  });

  it('reports why it was rejected and tries again', () => {
    client.connect();
    socket().lose();
    client.refused('64 viewers are connected');
    expect(listener.states.at(-1)).toEqual({
      status: 'waiting',
      attempt: 1,
      delay_ms: 500,
      reason: '64 viewers are connected',
    });
    timers.fire();
    const states = listener.states.length;
    client.refused('too late');
    expect(listener.states.length).toBe(states);
    expect(sockets.length).toBe(2);
  });

  it('gives up when the server does not take the token any more', () => {
    client.connect();
    socket().lose();
    client.lock();
    expect(listener.states.at(-1)).toEqual({ status: 'locked' });
    expect(timers.delays()).toEqual([]);
    client.connect();
    expect(sockets.length).toBe(1);
    expect(listener.states.at(-1)).toEqual({ status: 'locked' });
  });

  it('closes an open connection when it gives up', () => {
    watching();
    client.lock();
    expect(socket().closed).toBe(true);
    socket().lose();
    expect(listener.states.at(-1)).toEqual({ status: 'locked' });
  });

  it('tries at once when asked to', () => {
    client.connect();
    socket().lose();
    client.connect();
    expect(sockets.length).toBe(2);
    expect(timers.waiting.size).toBe(0);
  });

  it('watches the same run again with the rows that it has and restores the cursor', () => {
    watching();
    listener.rows = { truth: 10 };
    listener.commands = [{ type: 'seek', t_ns: 5 }];
    socket().lose();
    timers.fire();
    socket().hello();
    expect(socket().types()).toEqual(['watch', 'seek']);
    expect(socket().sent[0]).toMatchObject({ run: 'r1', resume: { truth: 10 } });
  });

  it('resumes without waiting when the server found it too slow', () => {
    watching();
    socket().lose(4000);
    expect(timers.delays()).toEqual([0]);
  });

  it('keeps out what still comes of the run left behind', () => {
    watching('old');
    listener.messages = [];
    client.unwatch('old');
    client.watch('new', 0);
    expect(socket().types().slice(-2)).toEqual(['unwatch', 'watch']);
    socket().receive(playbackMessage({ frame: 7 }, 'old'));
    socket().receive({ type: 'run', run: sampleRun({ id: 'old' }) });
    socket().receive({ type: 'metrics', run: 'old', metrics: {} });
    expect(listener.messages).toEqual([]);
    socket().receive(playbackMessage({ frame: 8 }, 'new'));
    expect(listener.messages).toMatchObject([{ type: 'playback', runs: { new: { frame: 8 } } }]);
  });

  it('reports a run that cannot be watched and does not try again', () => {
    client.connect();
    socket().hello();
    client.watch('gone', 0);
    const { request } = socket().last();
    socket().receive({ type: 'error', request, code: 'not_found', message: 'no such run' });
    expect(listener.failed).toEqual(['gone: no such run']);
    socket().lose();
    timers.fire();
    socket().hello();
    expect(socket().types()).toEqual([]);
  });

  it('names pictures as announced and ignores those of other runs', () => {
    watching();
    const pictures = [
      { id: 4, run: 'r1', name: 'camera' },
      { id: 6, run: 'old', name: 'camera' },
    ];
    socket().receive({ type: 'pictures', pictures });
    for (const id of [4, 5, 6]) socket().receive(picture(id));
    expect(listener.pictures).toEqual(['r1 camera']);
  });

  it('takes why a picture cannot be drawn for no answer, and ignores those of other runs', () => {
    watching();
    client.command({ type: 'seek', t_ns: 1 });
    socket().receive({ type: 'ok', request: socket().last().request });
    for (const run of ['r1', 'old']) {
      const error = { type: 'error', code: 'io', message: 'no tile', run, picture: 'scene' };
      socket().receive(error);
    }
    expect(client.settled, 'where the runs are then is still to come').toBe(false);
    expect(listener.messages.filter(({ type }) => type === 'error')).toMatchObject([{ run: 'r1' }]);
    socket().receive(playbackMessage());
    expect(client.settled).toBe(true);
  });

  it('survives unreadable messages and reports them', () => {
    watching();
    socket().receive(new ArrayBuffer(3));
    socket().onmessage?.({ data: '{' } as MessageEvent);
    expect(listener.protocolErrors.length).toBe(2);
    expect(socket().closed).toBe(false);
  });
});
