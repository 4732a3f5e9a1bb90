import { beforeEach, describe, expect, it } from 'vitest';

import { Address } from '../../../src/store/link/address';
import { linkOf } from '../../../src/store/link/link_state';
import { formatPermalink, parsePermalink } from '../../../src/store/link/permalink';
import { Layouts } from '../../../src/store/layouts/layouts';
import { Notices } from '../../../src/store/notices';
import { playbackMessage } from '../../support/samples';
import { Viewing } from '../../support/viewing';

let viewing: Viewing;
let hash: string;
let address: Address;

beforeEach(() => {
  viewing = new Viewing();
  const { store, session } = viewing;
  const layouts = new Layouts(
    store,
    new Notices(store, () => undefined),
    { getItem: () => null, setItem: () => undefined },
    { look: () => ({ view: '', show: '', sideBySide: true }), apply: () => undefined },
  );
  hash = '';
  address = new Address(
    { read: () => hash, replace: (text) => (hash = text) },
    {
      open: (text) => {
        const { runs, main, t_ns, choices } = parsePermalink(text);
        // Something on the screen that reports a change at once.
        address.update();
        session.showRuns(runs, main, t_ns, choices.clock);
      },
      shown: () => {
        const link = linkOf({ store, layouts, session });
        return link === null ? null : formatPermalink({ ...link, layout: null });
      },
    },
  );
});

function opens(text: string): void {
  hash = text;
  address.update();
}

/** The server answers the newest request, and says where the clock is then. */
function answers(change: Parameters<typeof playbackMessage>[0], run = 'r1'): void {
  const { socket } = viewing;
  socket.receive({ type: 'ok', request: socket.last().request });
  address.update();
  socket.receive(playbackMessage(change, run));
  address.update();
}

describe('Address', () => {
  it('opens an address before anything is written into it', () => {
    opens('#run=r1&t=1.5');
    expect(viewing.store.state.runId).toBe('r1');
    expect(hash).toBe('#run=r1&t=1.5');
  });

  it('writes nothing before runs and clock are where the address says', () => {
    opens('#run=r1&t=1.5');
    answers({ t_ns: 0 });
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', t_ns: 1.5e9 });
    expect(hash).toBe('#run=r1&t=1.5');
    // The clock of another message, on its way before the request arrived.
    viewing.socket.receive(playbackMessage({ t_ns: 0 }));
    address.update();
    expect(hash).toBe('#run=r1&t=1.5');
    answers({ t_ns: 1.5e9 });
    expect(hash).toBe('#run=r1&t=1.5');
    viewing.player.seekBy(0.25e9);
    answers({ t_ns: 1.75e9 });
    expect(hash).toBe('#run=r1&t=1.75');
  });

  it('does not write the screen of one address into the next one', () => {
    opens('#run=r1&t=1.5');
    answers({ t_ns: 0 });
    answers({ t_ns: 1.5e9 });
    // Another time of the same run, then another run; the event of the browser comes later.
    opens('#run=r1&t=0.5');
    expect(hash).toBe('#run=r1&t=0.5');
    answers({ t_ns: 0.5e9 });
    opens('#run=r2&t=1');
    viewing.socket.receive(playbackMessage({ t_ns: 0.5e9 }));
    address.update();
    expect(hash).toBe('#run=r2&t=1');
    expect(viewing.store.state.runId).toBe('r2');
    answers({ t_ns: 0 }, 'r2');
    answers({ t_ns: 1e9 }, 'r2');
    expect(hash).toBe('#run=r2&t=1');
  });

  it('is written again after a request that the server refused', () => {
    opens('#run=r1&t=1.5');
    answers({ t_ns: 0 });
    answers({ t_ns: 1.5e9 });
    viewing.session.command({ type: 'align', run: 'r1', mode: 'sim3' });
    viewing.session.setSideBySide(false);
    address.update();
    expect(hash).toBe('#run=r1&t=1.5');
    const { request } = viewing.socket.last();
    viewing.socket.receive({ type: 'error', request, code: 'conflict', message: 'not scored' });
    address.update();
    expect(hash).toBe('#run=r1&pictures=main&t=1.5');
  });

  it('is opened although the connection was lost, once it is there again', () => {
    opens('#run=r1&t=1.5');
    answers({ t_ns: 0 });
    answers({ t_ns: 1.5e9 });
    viewing.socket.lose();
    opens('#run=r1&t=0.5');
    expect(hash).toBe('#run=r1&t=0.5');
    viewing.timers.fire();
    viewing.socket.hello();
    answers({ t_ns: 1.5e9 });
    expect(viewing.socket.last()).toMatchObject({ type: 'seek', t_ns: 0.5e9 });
    expect(hash).toBe('#run=r1&t=0.5');
    answers({ t_ns: 0.5e9 });
    expect(hash).toBe('#run=r1&t=0.5');
  });
});
