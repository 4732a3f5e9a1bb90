import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Store } from '../../src/store/state';
import { acceptFiles } from '../../src/views/pages';
import type { Context } from '../../src/views/view';

let store: Store;
/** What became of the files. */
let done: string[];
let drop: (event: unknown) => void;

beforeEach(() => {
  store = new Store();
  done = [];
  const addEventListener = (type: string, listener: typeof drop) => {
    if (type === 'drop') drop = listener;
  };
  vi.stubGlobal('document', { addEventListener });
  const takes = (what: string) => () => Promise.resolve(void done.push(what));
  acceptFiles({
    store,
    notices: { error: (text: string) => done.push(text) },
    logs: { open: takes('logs'), send: takes('log') },
    scores: { send: takes('trajectory') },
    calibration: { send: takes('image') },
    missions: { import: takes('mission') },
    layoutExchange: { import: takes('layout') },
  } as unknown as Context);
});
afterEach(() => vi.unstubAllGlobals());

function dropFile(name: string, text: string): void {
  const dataTransfer = { types: ['Files'], files: [new File([text], name)] };
  drop({ dataTransfer, preventDefault: () => undefined });
}

/** Drops a file where each kind is taken. @param entries  how much becomes of them */
async function dropEverywhere(entries: number): Promise<void> {
  const { calibrationPage, missionPage, scorePage } = store.state;
  for (const page of [calibrationPage, scorePage, missionPage]) {
    store.state.openPage(page);
    dropFile('a.txt', 'x');
    page.open = false;
  }
  dropFile('flight.bin', 'x');
  dropFile('own.layouts.json', '{"overfly_layouts": 1, "layouts": []}');
  await expect.poll(() => done.length).toBeGreaterThanOrEqual(entries);
}

describe('dropped files', () => {
  it('are taken where they belong', async () => {
    await dropEverywhere(6);
    expect(done.sort()).toEqual(['image', 'layout', 'log', 'logs', 'mission', 'trajectory']);
  });

  it('are taken by the page that lies over the others', async () => {
    const { missionPage, scorePage } = store.state;
    store.state.openPage(missionPage);
    store.state.openPage(scorePage);
    dropFile('a.txt', 'x');
    await expect.poll(() => done).toEqual(['trajectory']);
  });

  it('of a viewer go nowhere but into this browser', async () => {
    store.setAccess('viewer');
    await dropEverywhere(5);
    const refusal = "Uploading needs the operator's address.";
    expect(done.sort()).toEqual([refusal, refusal, refusal, 'layout', 'mission']);
  });
});
