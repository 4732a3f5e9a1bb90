// A viewer's page shows the calibrations that operators begin and end.
import { beforeEach, describe, expect, it } from 'vitest';
import type { CalibrationClient } from '../../../src/connection/calibration_client';
import { RestError } from '../../../src/connection/rest_error';
import type { CalibrationSession } from '../../../src/protocol/calibration_types';
import { CalibrationDesk } from '../../../src/store/calibration/calibration_desk';
import { Notices } from '../../../src/store/notices';
import { Store } from '../../../src/store/state';
import { sampleSession } from '../../support/calibrations';

let store: Store;
let session: CalibrationSession | null;
/** The server is away. */
let away: boolean;
/** How often the sessions were asked for. */
let sought: number;
let waiting: { callback: () => void; delay_ms: number }[];
let desk: CalibrationDesk;

const page = () => store.state.calibrationPage;
const settle = () => new Promise((resolve) => setTimeout(resolve, 0));
const delays = () => waiting.map(({ delay_ms }) => delay_ms);
/** Lets the desk ask again. */
async function turn(): Promise<void> {
  for (const { callback } of waiting.splice(0)) callback();
  await settle();
}

beforeEach(() => {
  store = new Store();
  session = null;
  away = false;
  sought = 0;
  waiting = [];
  const client = {
    sources: () => Promise.resolve({ folders: [], recordings: [], cameras: [] }),
    saved: () => Promise.resolve([]),
    sessions: () => {
      sought += 1;
      if (away) return Promise.reject(new RestError(0, 'away', 'the server does not answer'));
      return Promise.resolve(session === null ? [] : [session]);
    },
    session: (id: string) =>
      session?.id === id
        ? Promise.resolve(session)
        : Promise.reject(new RestError(404, 'not_found', 'no such session')),
  } as unknown as CalibrationClient;
  desk = new CalibrationDesk(
    store,
    client,
    { scenario: () => Promise.resolve({}) },
    { setText: () => undefined },
    new Notices(store, () => undefined),
    (callback, delay_ms) => waiting.push({ callback, delay_ms }),
  );
});

describe('the calibration page of a viewer', () => {
  beforeEach(async () => {
    store.setAccess('viewer');
    await desk.open();
    await settle();
  });

  it('finds the session that is begun after it was opened', async () => {
    expect(page().session).toBeNull();
    expect(sought).toBe(1);
    expect(delays()).toEqual([3000]);
    session = sampleSession();
    await turn();
    expect(page().session?.id).toBe('s1');
    await turn();
    expect(sought).toBe(2);
    expect(delays()).toEqual([150]);
  });

  it('finds the session that is begun after another one has ended', async () => {
    session = sampleSession();
    await turn();
    session = null;
    await turn();
    expect(page().session).toBeNull();
    expect(page().error).toMatch(/closed/);
    session = sampleSession({ id: 's2' });
    await turn();
    expect(page()).toMatchObject({ session: { id: 's2' }, error: null });
  });

  it('looks again after the server was away, and no more once it is closed', async () => {
    away = true;
    await turn();
    expect(page().pollError).toBe('the server does not answer');
    away = false;
    await turn();
    expect(page().pollError).toBeNull();
    desk.close();
    sought = 0;
    await turn();
    expect(sought).toBe(0);
    expect(waiting).toEqual([]);
    session = sampleSession();
    await desk.open();
    await settle();
    expect(page().session?.id).toBe('s1');
  });
});

it('the calibration page of an operator looks once for the session that it has lost', async () => {
  await desk.open();
  await settle();
  expect(sought).toBe(1);
  expect(waiting).toEqual([]);
});
