import { beforeEach, describe, expect, it } from 'vitest';
import { playbackMessage } from '../support/samples';
import { Viewing } from '../support/viewing';

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

  it('plays from the begin again when it stands at the end', () => {
    viewing.watch();
    viewing.socket.receive(playbackMessage({ t_ns: 2e9 }));
    viewing.player.togglePlay();
    expect(viewing.socket.types().slice(-2)).toEqual(['seek', 'play']);
    viewing.socket.receive(playbackMessage({ playing: true }));
    viewing.player.togglePlay();
    expect(viewing.socket.last().type).toBe('pause');
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
