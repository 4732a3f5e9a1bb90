import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { listenToKeys } from '../../../src/views/commands/shortcuts';
import type { Context } from '../../../src/views/view';
import { Viewing } from '../../support/viewing';

let viewing: Viewing;
let listeners: ((event: unknown) => void)[];

beforeEach(() => {
  listeners = [];
  const addEventListener = (type: string, listener: (event: unknown) => void) => {
    if (type === 'keydown') listeners.push(listener);
  };
  vi.stubGlobal('document', { addEventListener });
  const controls = ['Select', 'TextArea', 'Input', 'Button'];
  for (const name of controls)
    vi.stubGlobal(
      `HTML${name}Element`,
      class {
        readonly control = name;
      },
    );
  viewing = new Viewing();
  viewing.watch();
  const { store, player } = viewing;
  listenToKeys({ store, player, layouts: { restore: () => undefined } } as unknown as Context);
});
afterEach(() => vi.unstubAllGlobals());

function press(key: string): void {
  const event = { key, target: null, preventDefault: () => undefined };
  for (const listener of listeners) listener(event);
}

describe('the shortcuts', () => {
  it('steer nothing behind a page', () => {
    const { state } = viewing.store;
    state.sweepPage.open = true;
    const sent = viewing.socket.sent.length;
    press(' ');
    press('?');
    expect(viewing.socket.sent).toHaveLength(sent);
    expect(state.helpOpen).toBe(true);
    press('Escape');
    expect(state.covered).toBe(false);
    press(' ');
    expect(viewing.socket.last().type).toBe('play');
  });

  it('close everything that lies over the dashboard', () => {
    const { state } = viewing.store;
    for (const page of state.pages) page.open = true;
    state.connect.open = true;
    press('Escape');
    expect(state.covered).toBe(false);
    expect(state.connect.open).toBe(false);
  });
});
