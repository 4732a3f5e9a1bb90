import { beforeEach, describe, expect, it } from 'vitest';
import { RestClient } from '../../../src/connection/rest_client';
import { LogSmoothing } from '../../../src/store/logs/log_smoothing';
import type { LogInfo } from '../../../src/protocol/log_types';
import { Store } from '../../../src/store/state';

const kInfo = { name: 'a.bin', streams: [], events: [], warnings: [] } as unknown as LogInfo;

let store: Store;
let asked: { url: string; signal: AbortSignal | null }[];
let answers: ((response: Response) => void)[];
let waiting: (() => void)[];
let smoothing: LogSmoothing;

const settle = () => new Promise((resolve) => setTimeout(resolve, 0));
const state = () => store.state.logPage.smoothing;

function fire(): void {
  const due = waiting;
  waiting = [];
  for (const callback of due) callback();
}

beforeEach(() => {
  store = new Store();
  Object.assign(store.state.logPage, { open: true, chosen: 'logs/a.bin', info: kInfo });
  asked = [];
  answers = [];
  waiting = [];
  const rest = new RestClient('api', (url, init) => {
    asked.push({ url, signal: init?.signal ?? null });
    return new Promise((resolve) => answers.push(resolve));
  });
  let key = 0;
  smoothing = new LogSmoothing(
    store,
    rest,
    (callback) => waiting.push(callback),
    () => `key-${(key += 1)}`,
  );
});

describe('LogSmoothing', () => {
  it('asks for the chosen slice once it is shown, and for the progress', async () => {
    smoothing.refresh();
    expect(asked).toEqual([]);
    Object.assign(store.state.logPage.flight, { source: 'GPS', from_s: 3, autoOffset: true });
    smoothing.show(true);
    smoothing.refresh();
    expect(asked.map(({ url }) => url)).toEqual([
      'api/logs/logs%2Fa.bin/residuals?progress=key-1&source=GPS&from_s=3&time_offset_s=auto',
    ]);
    fire();
    expect(asked[1]?.url).toBe('api/progress/key-1');
    answers[1]?.(Response.json({ step: 'attitudes', share: 0.25 }));
    await settle();
    expect(state().progress).toEqual({ step: 'attitudes', share: 0.25 });
    answers[0]?.(Response.json({ jump_count: 0 }));
    await settle();
    expect(state()).toMatchObject({ progress: null, error: null, residuals: { jump_count: 0 } });
    fire();
    expect(asked).toHaveLength(2);
  });

  it('ends what is not wanted any more', async () => {
    smoothing.show(true);
    store.state.logPage.flight.to_s = 9;
    smoothing.refresh();
    expect(asked.map(({ signal }) => signal?.aborted)).toEqual([true, false]);
    answers[0]?.(Response.json({ jump_count: 1 }));
    await settle();
    expect(state().residuals).toBeNull();
    smoothing.show(false);
    expect(asked[1]?.signal?.aborted).toBe(true);
    expect(state().progress).toBeNull();
    smoothing.show(true);
    expect(asked).toHaveLength(3);
  });

  it('drops the residuals when another log is chosen, or none, but not when it is hidden', async () => {
    const residuals = { jump_count: 0 };
    smoothing.show(true);
    answers[0]?.(Response.json(residuals));
    await settle();
    smoothing.show(false);
    smoothing.show(true);
    expect(state().residuals).toEqual(residuals);
    Object.assign(store.state.logPage, { chosen: 'logs/b.bin', info: null });
    smoothing.refresh();
    expect(state().residuals).toBeNull();
    store.state.logPage.info = kInfo;
    smoothing.refresh();
    expect(asked).toHaveLength(2);
    answers[1]?.(Response.json(residuals));
    await settle();
    Object.assign(store.state.logPage, { chosen: null, info: null });
    smoothing.refresh();
    expect(state()).toMatchObject({ residuals: null, error: null, progress: null });
  });

  it('is cancelled by the viewer, and begun again', async () => {
    smoothing.show(true);
    smoothing.cancel();
    smoothing.refresh();
    expect(asked[0]?.signal?.aborted).toBe(true);
    expect(state()).toMatchObject({ progress: null, error: 'Cancelled' });
    expect(asked).toHaveLength(1);
    smoothing.again();
    answers[1]?.(
      Response.json({ error: { code: 'unreadable', message: 'too few' } }, { status: 422 }),
    );
    await settle();
    expect(state()).toMatchObject({ progress: null, error: 'too few' });
  });
});
