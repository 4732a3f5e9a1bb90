import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { listenToKeys } from '../../../src/views/commands/shortcuts';
import type { Context } from '../../../src/views/view';
import { Viewing } from '../../support/viewing';

let viewing: Viewing;
let listeners: ((event: unknown) => void)[];
/** What was closed by its own close(), in this order. */
let closed: string[];

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
  const { state } = store;
  closed = [];
  const desk = (name: string, page: { open: boolean }) => ({
    close: () => {
      page.open = false;
      closed.push(name);
    },
  });
  const desks = {
    connect: desk('connect', state.connect),
    scenarios: desk('scenarios', state.scenarioEditor),
    logs: desk('logs', state.logPage),
    scores: desk('scores', state.scorePage),
    calibration: desk('calibration', state.calibrationPage),
    missions: desk('missions', state.missionPage),
    sweeps: desk('sweeps', state.sweepPage),
    studies: desk('studies', state.studyPage),
  };
  const layouts = { restore: () => closed.push('layouts') };
  listenToKeys({ store, player, layouts, ...desks } as unknown as Context);
});
afterEach(() => vi.unstubAllGlobals());

function press(key: string): void {
  const event = { key, target: null, preventDefault: () => undefined };
  for (const listener of listeners) listener(event);
}

describe('the shortcuts', () => {
  it('steer nothing behind a page', () => {
    const { state } = viewing.store;
    state.openPage(state.sweepPage);
    const sent = viewing.socket.sent.length;
    press(' ');
    press('?');
    expect(viewing.socket.sent).toHaveLength(sent);
    expect(state.helpOpen).toBe(true);
    press('Escape');
    expect(state.helpOpen).toBe(false);
    expect(state.covered, 'the help lies over the page').toBe(true);
    press('Escape');
    expect(state.covered).toBe(false);
    press(' ');
    expect(viewing.socket.last().type).toBe('play');
  });

  it('close one thing after the other, the topmost first, each by its own close()', () => {
    const { state } = viewing.store;
    for (const page of state.pages) state.openPage(page);
    state.openPage(state.scorePage);
    state.connect.open = true;
    state.paletteOpen = true;
    press('Escape');
    expect(state.paletteOpen).toBe(false);
    expect(closed).toEqual([]);
    for (let i = 0; i < 9; i += 1) press('Escape');
    expect(closed).toEqual([
      'connect',
      'scores',
      'studies',
      'sweeps',
      'missions',
      'calibration',
      'logs',
      'scenarios',
      'layouts',
    ]);
    expect(state.covered).toBe(false);
  });
});
