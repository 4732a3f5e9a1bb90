import { beforeEach, describe, expect, it, vi } from 'vitest';
import { RestClient } from '../../../src/connection/rest_client';
import { SweepClient } from '../../../src/connection/sweep_client';
import type { Notices } from '../../../src/store/notices';
import type { Session } from '../../../src/store/session';
import { Store } from '../../../src/store/state';
import { SweepDesk } from '../../../src/store/sweeps/sweep_desk';

const entry = (name: string, flying = false) => ({
  name,
  title: '',
  estimators: [],
  repeats: 1,
  axes: [],
  flying,
  here: null as 'flying' | 'cancelling' | null,
  problem: null as string | null,
  envelope: null as { axis: string; estimator: string; found: boolean } | null,
  progress: null as { passed: number; most: number } | null,
  changed_utc: '',
});

let store: Store;
let asked: string[];
let sent: unknown[];
let sweeps: ReturnType<typeof entry>[];
let failing: boolean;
let waiting: { callback: () => void; delay_ms: number }[];
let refused: boolean;
const selectRun = vi.fn();
const notices = { info: vi.fn(), error: vi.fn() };
let desk: SweepDesk;

const next = async () => {
  waiting.shift()?.callback();
  await new Promise((resolve) => setTimeout(resolve));
};

beforeEach(() => {
  store = new Store();
  asked = [];
  sent = [];
  sweeps = [entry('b', true), entry('a')];
  failing = false;
  waiting = [];
  refused = false;
  selectRun.mockClear();
  notices.info.mockClear();
  notices.error.mockClear();
  const rest = new RestClient('api', (url, init) => {
    asked.push(init?.method === 'GET' ? url : `${init?.method} ${url}`);
    if (typeof init?.body === 'string') sent.push(JSON.parse(init.body));
    if (refused && init?.method === 'POST') {
      const error = { code: 'sweep_flying', message: 'sweep "b" is flying' };
      return Promise.resolve(Response.json({ error }, { status: 429 }));
    }
    if (failing) {
      const error = { code: 'unreadable', message: 'sweep.json: cannot be read' };
      return Promise.resolve(Response.json({ error }, { status: 422 }));
    }
    if (init?.method === 'DELETE') {
      sweeps = sweeps.filter(({ name }) => !url.endsWith(`/${name}`));
      return Promise.resolve(new Response(null, { status: 204 }));
    }
    if (url === 'api/sweeps') return Promise.resolve(Response.json({ sweeps }));
    const sweep = sweeps.find(({ name }) => url.endsWith(`/${name}`));
    return Promise.resolve(Response.json({ sweep, table: null }));
  });
  const session = { selectRun } as unknown as Session;
  desk = new SweepDesk(
    store,
    new SweepClient(rest),
    session,
    notices as unknown as Notices,
    (callback, delay_ms) => waiting.push({ callback, delay_ms }),
  );
});

describe('SweepDesk', () => {
  it('shows the newest sweep, and reads again soon while one flies', async () => {
    await desk.open();
    expect(store.state.sweepPage.name).toBe('b');
    expect(store.state.sweepPage.shown?.sweep.name).toBe('b');
    expect(waiting.map(({ delay_ms }) => delay_ms)).toEqual([3000]);
    sweeps = [entry('b'), entry('a')];
    await next();
    expect(asked).toHaveLength(4);
    expect(waiting.map(({ delay_ms }) => delay_ms)).toEqual([15000]);
  });

  it('reads only the list of a closed page, until no sweep flies any more', async () => {
    await desk.open();
    desk.close();
    asked = [];
    await next();
    expect(asked).toEqual(['api/sweeps']);
    sweeps = [entry('b'), entry('a')];
    await next();
    expect(waiting).toEqual([]);
    expect(notices.info).toHaveBeenCalledOnce();
  });

  it('says how a sweep ended, but not that the viewer cancelled it', async () => {
    await desk.open();
    sweeps = [{ ...entry('b'), progress: { passed: 6, most: 6 } }, entry('a', true)];
    await next();
    expect(notices.info).toHaveBeenLastCalledWith('b: the sweep is complete.');
    sweeps = [{ ...entry('b', true) }, { ...entry('a'), progress: { passed: 2, most: 6 } }];
    await next();
    expect(notices.info).toHaveBeenLastCalledWith('a: the sweep stopped after 2 of 6 flights.');
    sweeps = [{ ...entry('b'), problem: 'the disk is full' }, entry('a', true)];
    await next();
    expect(notices.error).toHaveBeenLastCalledWith('b: the sweep failed. the disk is full');
    await desk.cancel('a');
    sweeps = [entry('b'), { ...entry('a'), progress: { passed: 2, most: 6 } }];
    waiting = waiting.slice(-1);
    await next();
    expect(notices.info).toHaveBeenCalledTimes(2);
  });

  it('deletes a sweep, and shows another one in its place', async () => {
    sweeps = [entry('b'), entry('a')];
    await desk.open();
    await desk.remove('b');
    expect(asked).toContain('DELETE api/sweeps/b');
    expect(store.state.sweepPage.name).toBe('a');
    expect(store.state.sweepPage.shown?.sweep.name).toBe('a');
    await desk.remove('a');
    expect(store.state.sweepPage).toMatchObject({ name: null, shown: null });
    expect(notices.error).not.toHaveBeenCalled();
  });

  it('does not open its page again when it was closed meanwhile', async () => {
    const begin = () => {
      const empty = { changes: null, files: null, file: null, loaded: 0, jobs: 1, cost: null };
      const border = { axis: '', estimator: '' };
      const idle = { checking: false, starting: false, errors: [] };
      store.state.sweepPage.form = { ...empty, ...idle, border, name: 'b', text: '{}' };
      return desk.form.start();
    };
    for (const act of [
      () => desk.cancel('b'),
      () => desk.continue('a'),
      () => desk.remove('a'),
      begin,
    ]) {
      await desk.open();
      asked = [];
      waiting = [];
      const acting = act();
      desk.close();
      await acting;
      expect(store.state.sweepPage.open).toBe(false);
      // The list of a closed page, and again while a sweep flies.
      expect(asked.slice(1)).toEqual(['api/sweeps']);
      expect(waiting).toHaveLength(1);
    }
    expect(notices.error).not.toHaveBeenCalled();
  });

  it('continues a sweep and shows it', async () => {
    await desk.open();
    await desk.continue('a');
    expect(asked).toContain('POST api/sweeps/a/continue');
    expect(store.state.sweepPage.name).toBe('a');
    refused = true;
    await desk.continue('a');
    expect(notices.error).toHaveBeenCalledWith('sweep "b" is flying');
  });

  it('looks on for a border that was not found, and flies the other cells of one that was', async () => {
    const sought = { axis: 'h', estimator: 'feature', found: false };
    sweeps = [{ ...entry('a'), envelope: sought }];
    await desk.open();
    await desk.continue('a');
    sweeps = [{ ...entry('a', true), envelope: sought }];
    waiting = waiting.slice(-1);
    await next();
    sweeps = [
      { ...entry('a'), envelope: { ...sought, found: true }, progress: { passed: 3, most: 8 } },
    ];
    await next();
    expect(notices.info).toHaveBeenLastCalledWith('a: the border is found, with 3 of 8 flights.');
    await desk.continue('a');
    expect(sent).toEqual([{ border: { axis: 'h', estimator: 'feature' } }, {}]);
  });

  it('keeps the chosen sweep, and forgets the cell of another', async () => {
    await desk.open();
    desk.chooseCell('x');
    await desk.choose('a');
    expect(store.state.sweepPage.cell).toBeNull();
    await next();
    expect(store.state.sweepPage.shown?.sweep.name).toBe('a');
    sweeps = [entry('b')];
    await next();
    expect(store.state.sweepPage.name).toBe('b');
  });

  it('exchanges the axes', () => {
    desk.chooseAxis('columns', 'v', { columns: 'h', rows: 'v' });
    const { columns, rows } = store.state.sweepPage;
    expect([columns, rows]).toEqual(['v', 'h']);
  });

  it('opens a flight in the dashboard', async () => {
    await desk.open();
    desk.openRun('b.0123456789abcdef0123');
    expect(selectRun).toHaveBeenCalledWith('b.0123456789abcdef0123');
    expect(store.state.sweepPage.open).toBe(false);
  });

  it('says why a sweep cannot be read, and tries again', async () => {
    failing = true;
    await desk.open();
    expect(store.state.sweepPage.error).toBe('sweep.json: cannot be read');
    failing = false;
    await next();
    expect(store.state.sweepPage.error).toBeNull();
  });
});
