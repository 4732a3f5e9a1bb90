import { beforeEach, describe, expect, it } from 'vitest';

import { RestClient } from '../../../src/connection/rest_client';

import type { UploadAnswer } from '../../../src/connection/upload';
import { LogBrowser } from '../../../src/store/logs/log_browser';
import { sampleRun } from '../../support/samples';
import { Viewing } from '../../support/viewing';

// Node 18 has no global `File`.
const file = (name: string) => Object.assign(new Blob(['x']), { name }) as unknown as File;

interface Request {
  method: string;
  url: string;
  body: string;
  signal: AbortSignal | null;
  answer: (document: unknown) => void;
}

const kSeries = {
  position_source: 'GPS',
  attitude_source: 'ATT',
  vehicle: '',
  run: 0,
  georeferenced: true,
  positions: { t_s: [0, 1] },
  speeds: {},
  attitudes: {},
  steps: [],
};

const entry = (name: string) => ({
  name,
  file: `/data/${name}`,
  format: 'dataflash',
  size_bytes: 1,
  uploaded: true,
});
const list = (...names: string[]) => ({
  logs: names.map(entry),
  complete: true,
  uploads: { used_bytes: 0, quota_bytes: 9, max_bytes: 9 },
});
const info = (name: string) => ({ name, truth: null, streams: [], events: [], warnings: [] });

let viewing: Viewing;
let requests: Request[];
let uploads: ((answer: UploadAnswer) => void)[];
let browser: LogBrowser;

/** Lets answers arrive. */
const settle = () => new Promise((resolve) => setTimeout(resolve, 0));

/** Answers the oldest request that waits for this. */
async function answer(method: string, url: string, document: unknown): Promise<void> {
  const at = requests.findIndex((each) => each.method === method && each.url === `api${url}`);
  const [request] = requests.splice(at, 1);
  if (at < 0 || request === undefined) throw new Error(`${method} ${url} was not asked for`);
  request.answer(document);
  await settle();
}

beforeEach(() => {
  viewing = new Viewing();
  requests = [];
  uploads = [];
  const rest = new RestClient(
    'api',
    (url, init) =>
      new Promise((resolve) => {
        requests.push({
          method: init?.method ?? 'GET',
          url,
          body: typeof init?.body === 'string' ? init.body : '',
          signal: init?.signal ?? null,
          answer: (document) =>
            resolve(
              document instanceof Response
                ? document
                : document === null
                  ? new Response(null, { status: 204 })
                  : Response.json(document),
            ),
        });
      }),
  );
  browser = new LogBrowser(
    viewing.store,
    rest,
    viewing.session,
    () => new Promise((resolve) => uploads.push(resolve)),
    () => 'key',
  );
});

const page = () => viewing.store.state.logPage;

describe('LogBrowser', () => {
  it('forgets a log that is deleted while it is read', async () => {
    void browser.choose('a.bin');
    const reading = requests[0];
    void browser.remove('a.bin');
    await answer('DELETE', '/logs/a.bin', null);
    expect(reading?.signal?.aborted).toBe(true);
    expect(page().reading).toBe(false);
    await answer('GET', '/logs', list());
    // The answer was on its way.
    await answer('GET', '/logs/a.bin', info('a.bin'));
    expect(requests).toHaveLength(0);
    expect(page().chosen).toBeNull();
    expect(page().info).toBeNull();
    expect(page().series).toBeNull();
  });

  it('shows the newest list, whichever answer comes first', async () => {
    void browser.readList();
    void browser.readList();
    const [older, newer] = requests;
    newer?.answer(list('b.bin'));
    await settle();
    older?.answer(list('a.bin'));
    await settle();
    expect(page().list?.logs.map(({ name }) => name)).toEqual(['b.bin']);
  });

  it('flies the log with the form that was there', async () => {
    void browser.readList();
    await answer('GET', '/logs', list('a.bin', 'b.bin'));
    void browser.choose('a.bin');
    browser.set({ scenario: 'course', smooth: false, rebase: false, from_s: 10 });
    void browser.fly();
    void browser.choose('b.bin');
    browser.set({ scenario: 'other' });
    await answer('GET', '/scenarios/course', { estimators: [] });
    const start = requests.find(({ method }) => method === 'POST');
    expect(JSON.parse(start?.body ?? '{}')).toMatchObject({
      scenario: 'course',
      overrides: { flight: { log: { file: '/data/a.bin', from_s: 10 } } },
    });
    await answer('POST', '/runs', sampleRun());
    expect(page().open).toBe(false);
  });

  it('shows the progress of an upload that begins while the one before is read', async () => {
    const done = (name: string) => ({ status: 201, text: JSON.stringify(entry(name)) });
    void browser.send([file('a.bin')]);
    uploads[0]?.(done('a.bin'));
    await settle();
    expect(page().upload).toBeNull();
    void browser.send([file('b.bin')]);
    await answer('GET', '/logs', list('a.bin'));
    await answer('GET', '/logs/a.bin', info('a.bin'));
    await answer('GET', '/logs/a.bin/series', kSeries);
    expect(page().chosen).toBe('a.bin');
    expect(page().upload?.name).toBe('b.bin');
    uploads[1]?.({ status: 422, text: '{"error":{"code":"unreadable","message":"no log"}}' });
    await settle();
    expect(page().upload).toBeNull();
    expect(page().uploadError).toBe('b.bin: no log');
  });

  it('uploads files that are dropped during an upload after it', async () => {
    const done = (name: string) => ({ status: 201, text: JSON.stringify(entry(name)) });
    void browser.send([file('a.bin')]);
    void browser.send([file('b.bin'), file('c.bin')]);
    expect(uploads).toHaveLength(1);
    uploads[0]?.(done('a.bin'));
    await settle();
    await answer('GET', '/logs', list('a.bin'));
    await answer('GET', '/logs/a.bin', info('a.bin'));
    await answer('GET', '/logs/a.bin/series', kSeries);
    expect(uploads).toHaveLength(2);
    expect(page().upload?.name).toBe('b.bin');
    uploads[1]?.({ status: 413, text: '{"error":{"code":"full","message":"no room"}}' });
    await settle();
    expect(page().uploadError).toBe('b.bin: no room\nNot uploaded: c.bin');
    expect(page().upload).toBeNull();
    expect(uploads).toHaveLength(2);
  });

  it('leaves the log alone that was chosen during an upload', async () => {
    void browser.send([file('a.bin')]);
    void browser.choose('b.bin');
    await answer('GET', '/logs/b.bin', info('b.bin'));
    await answer('GET', '/logs/b.bin/series', kSeries);
    browser.set({ source: 'EKF' });
    uploads[0]?.({ status: 201, text: JSON.stringify(entry('a.bin')) });
    await settle();
    await answer('GET', '/logs', list('a.bin', 'b.bin'));
    expect(page().chosen).toBe('b.bin');
    expect(page().flight.source).toBe('EKF');
  });

  it('names the log whose flight was refused, if another one is shown', async () => {
    void browser.readList();
    await answer('GET', '/logs', list('a.bin', 'b.bin'));
    const refusedAfter = async (choose: () => void) => {
      void browser.choose('a.bin');
      await answer('GET', '/logs/a.bin', info('a.bin'));
      await answer('GET', '/logs/a.bin/series', kSeries);
      browser.set({ scenario: 'course' });
      void browser.fly();
      choose();
      const refusal = { error: { code: 'not_found', message: 'no scenario' } };
      await answer('GET', '/scenarios/course', Response.json(refusal, { status: 404 }));
      return page().flightErrors.map(({ message }) => message);
    };
    expect(await refusedAfter(() => undefined)).toEqual(['no scenario']);
    expect(await refusedAfter(() => void browser.choose('b.bin'))).toEqual(['a.bin: no scenario']);
  });

  it('says why a log could not be deleted', async () => {
    void browser.remove('a.bin');
    const error = { code: 'conflict', message: 'it is in use' };
    await answer('DELETE', '/logs/a.bin', Response.json({ error }, { status: 409 }));
    await answer('GET', '/logs', list('a.bin'));
    expect(page().listError).toBe('it is in use');
  });
});
