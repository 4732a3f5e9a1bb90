import { beforeEach, describe, expect, it } from 'vitest';

import { CalibrationClient } from '../../../src/connection/calibration_client';
import { RestClient } from '../../../src/connection/rest_client';

import type { CalibrationSession } from '../../../src/protocol/calibration_types';
import { CalibrationDesk } from '../../../src/store/calibration/calibration_desk';
import { Notices } from '../../../src/store/notices';
import { ScenarioDesk } from '../../../src/store/scenario/scenario_desk';
import { Store } from '../../../src/store/state';
import { sampleSession, sampleSolution } from '../../support/calibrations';

interface Asked {
  method: string;
  url: string;
  body: unknown;
}

let store: Store;
let asked: Asked[];
let session: CalibrationSession | null;
/** Names of saved calibrations. */
let saved: string[];
let later: (() => void)[];
/** Of the launcher's scenario, which wait for a pause. */
let checks: (() => void)[];
let refusals: number;
/** Estimates of fewer views are refused. */
let leastViews: number;
/** The server is away. */
let away: boolean;
/** The list of what is saved comes when these are called. */
let held: (() => void)[] | null;
let desk: CalibrationDesk;

const refusal = (status: number, code: string) =>
  Response.json({ error: { code, message: code } }, { status });

function answer(method: string, url: string, body: unknown): Response {
  if (url === 'api/calibration-sources') {
    const folders = [{ name: 'data/photos', images: 9 }];
    const sources = { folders, recordings: [], cameras: [], keeps: true, complete: true };
    return Response.json(sources);
  }
  if (url === 'api/calibrations' && method === 'GET') {
    return Response.json({ calibrations: saved.map((name) => ({ name })) });
  }
  if (url === 'api/calibrations') return Response.json({ name: 'c', file: '/c.json' });
  if (url.startsWith('api/scenarios/')) return Response.json({ cameras: [{ name: 'down' }] });
  if (url === 'api/calibration-sessions' && method === 'GET') {
    return Response.json({ sessions: session === null ? [] : [session] });
  }
  if (url === 'api/calibration-sessions') {
    session = sampleSession();
    return Response.json(session, { status: 201 });
  }
  if (url.startsWith('api/calibrations/') && method === 'DELETE') {
    return new Response(null, { status: 204 });
  }
  if (url.startsWith('api/calibrations/')) {
    return url.endsWith('=dso') ? refusal(422, 'k3 must be 0') : new Response('fx_px: 500');
  }
  if (session === null) return refusal(404, 'not_found');
  if (url.includes('/images?')) {
    refusals -= 1;
    return refusals >= 0 ? refusal(429, 'too_many_images') : Response.json({}, { status: 202 });
  }
  if (url.endsWith('/solution') && method === 'GET') return Response.json(sampleSolution());
  if (url.endsWith('/solution')) {
    const { left_out } = body as { left_out: number[] };
    const left = session.views.length - left_out.length;
    return left < leastViews ? refusal(409, 'too_few') : Response.json(session);
  }
  if (url.includes('/views/')) return Response.json({ view: 2, residuals: null });
  if (url.includes(`revision=${session.revision}`)) return new Response(null, { status: 204 });
  if (method === 'DELETE') {
    session = null;
    return new Response(null, { status: 204 });
  }
  return Response.json(session);
}

beforeEach(() => {
  store = new Store();
  store.state.scenarioName = 'course';
  asked = [];
  session = null;
  saved = [];
  later = [];
  checks = [];
  refusals = 0;
  leastViews = 0;
  away = false;
  held = null;
  const rest = new RestClient('api', (url, init) => {
    const method = init?.method ?? 'GET';
    const body: unknown = typeof init?.body === 'string' ? JSON.parse(init.body) : null;
    asked.push({ method, url, body });
    if (away) return Promise.reject(new TypeError('refused'));
    const response = answer(method, url, body);
    if (held === null || url !== 'api/calibrations' || method !== 'GET') {
      return Promise.resolve(response);
    }
    const wait = held;
    return new Promise((resolve) => wait.push(() => resolve(response)));
  });
  const wait = (callback: () => void) => later.push(callback);
  const notices = new Notices(store, () => 0);
  const none = () => Promise.resolve();
  const list = {
    readScenarios: none,
    selectScenario: none,
    lookAgain: () => Promise.resolve('same' as const),
  };
  const scenarios = new ScenarioDesk(store, rest, list, notices, (check) => checks.push(check));
  desk = new CalibrationDesk(store, new CalibrationClient(rest), rest, scenarios, notices, wait);
});

/** The session as it is after an estimate was begun. */
function withLeftOut(...left: number[]): CalibrationSession {
  const views = sampleSession().views.map((one) => ({ ...one, left_out: left.includes(one.view) }));
  return sampleSession({ revision: (session?.revision ?? 0) + 1, views });
}

const page = () => store.state.calibrationPage;
const settle = () => new Promise((resolve) => setTimeout(resolve, 0));
/** Lets the desk ask again. */
async function turn(): Promise<void> {
  for (const callback of later.splice(0)) callback();
  await settle();
}

describe('CalibrationDesk', () => {
  it('opens with the sources, the scenario of the launcher and its cameras', async () => {
    await desk.open();
    expect(page().open).toBe(true);
    expect(page().form.names).toMatchObject({ scenario: 'course', folder: 'data/photos' });
    expect(page().cameras).toEqual(['down']);
    expect(page().form.camera).toBe('down');
    expect(page().session).toBeNull();
  });

  it('goes on with a session that the page has lost', async () => {
    session = sampleSession();
    await desk.open();
    expect(page().session?.id).toBe('s1');
  });

  it('follows a session and reads its estimate when there is one', async () => {
    await desk.open();
    await desk.begin();
    await settle();
    expect(page().session?.phase).toBe('taking');
    session = sampleSession({ revision: 6, phase: 'waiting', solution: 1 });
    await turn();
    expect(page().session?.revision).toBe(6);
    expect(page().solution?.rms_px).toBe(0.05);
  });

  it('says what is wrong with the form and asks for nothing', async () => {
    await desk.open();
    desk.set({ cols: '7', rows: '7' });
    await desk.begin();
    expect(page().error).toContain('half a turn');
    expect(asked.filter(({ method }) => method === 'POST')).toEqual([]);
  });

  it('leaves a view out of the next estimate, or takes it in again', async () => {
    await desk.open();
    await desk.begin();
    await desk.toggleView(0);
    expect(asked.at(-1)?.body).toEqual({ model: 'radtan', k3: false, left_out: [0, 1] });
    session = withLeftOut(0, 1);
    await turn();
    await desk.toggleView(1);
    expect(asked.at(-1)?.body).toMatchObject({ left_out: [0] });
    session = withLeftOut(0);
    await turn();
    desk.set({ model: 'equidistant' });
    await desk.solve();
    expect(asked.at(-1)?.body).toMatchObject({ model: 'equidistant', left_out: [0] });
  });

  it('leaves out all views that are chosen while an estimate is made', async () => {
    await desk.open();
    await desk.begin();
    await Promise.all([desk.toggleView(0), desk.toggleView(2)]);
    await desk.solve();
    const bodies = asked.filter(({ url }) => url.endsWith('/solution')).map(({ body }) => body);
    expect(bodies).toMatchObject([
      { left_out: [0, 1] },
      { left_out: [0, 1, 2] },
      { left_out: [0, 1, 2] },
    ]);
    expect(page().leftOut).toEqual(new Set([0, 1, 2]));
    session = withLeftOut(0, 1);
    await turn();
    expect(page().leftOut, 'the first estimate').toEqual(new Set([0, 1, 2]));
    session = withLeftOut(0, 1, 2);
    await turn();
    expect(page().leftOut).toBeNull();
  });

  it('takes a view in again if the server refuses the estimate without it', async () => {
    await desk.open();
    await desk.begin();
    leastViews = 2;
    await desk.toggleView(0);
    expect(page()).toMatchObject({ error: 'too_few', leftOut: null });
    leastViews = 1;
    await Promise.all([desk.toggleView(0), desk.toggleView(2)]);
    expect(page()).toMatchObject({ error: 'too_few', leftOut: new Set([0, 1]) });
    await desk.control({ clear: true });
    expect(page().leftOut).toBeNull();
  });

  it('says why a saved calibration cannot be written for a program', async () => {
    expect(await (await desk.file('c', 'ros'))?.text()).toBe('fx_px: 500');
    expect(await desk.file('c', 'dso')).toBeNull();
    expect(store.state.notices.map(({ text }) => text)).toEqual([
      'c cannot be downloaded: k3 must be 0',
    ]);
  });

  it('sends images one by one and waits while the server has enough', async () => {
    await desk.open();
    await desk.begin();
    page().session = sampleSession({ uploads: true });
    session = page().session;
    refusals = 1;
    const sending = desk.send([new File(['x'], 'a.png'), new File(['y'], 'b.png')]);
    await settle();
    await turn();
    await sending;
    const urls = asked.filter(({ url }) => url.includes('/images?')).map(({ url }) => url);
    expect(urls.map((url) => url.slice(-5))).toEqual(['a.png', 'a.png', 'b.png']);
    expect(page().sending).toBeNull();
    expect(page().error).toBeNull();
  });

  it('sends images that are chosen while others are sent after them', async () => {
    await desk.open();
    await desk.begin();
    page().session = sampleSession({ uploads: true });
    session = page().session;
    refusals = 1;
    const first = desk.send([new File(['x'], 'a.png')]);
    const second = desk.send([new File(['y'], 'b.png'), new File(['z'], 'c.png')]);
    expect(page().sending).toEqual({ done: 0, total: 3 });
    await settle();
    await turn();
    await Promise.all([first, second]);
    const urls = asked.filter(({ url }) => url.includes('/images?')).map(({ url }) => url);
    expect(urls.map((url) => url.slice(-5))).toEqual(['a.png', 'a.png', 'b.png', 'c.png']);
    expect(page().sending).toBeNull();
    expect(page().error).toBeNull();
  });

  it('sends the images of the session before no further', async () => {
    await desk.open();
    await desk.begin();
    page().session = sampleSession({ uploads: true });
    session = page().session;
    refusals = 1;
    const before = desk.send([new File(['x'], 'a.png'), new File(['y'], 'b.png')]);
    await settle();
    await desk.begin();
    page().session = sampleSession({ id: 's2', uploads: true });
    const now = desk.send([new File(['z'], 'c.png')]);
    await turn();
    await Promise.all([before, now]);
    const urls = asked.filter(({ url }) => url.includes('/images?')).map(({ url }) => url);
    expect(urls.map((url) => /sessions\/(\w+).*=(.*)/.exec(url)?.slice(1))).toEqual([
      ['s1', 'a.png'],
      ['s2', 'c.png'],
      ['s1', 'a.png'],
    ]);
    expect(page().sending).toBeNull();
    expect(page().error).toBeNull();
  });

  it('tells when the server has closed the session', async () => {
    await desk.open();
    await desk.begin();
    await settle();
    session = null;
    await turn();
    expect(page().session).toBeNull();
    expect(page().error).toContain('closed');
  });

  it('shows a lost connection until the session is followed again, and hides no other error', async () => {
    await desk.open();
    await desk.begin();
    await settle();
    away = true;
    await turn();
    expect(page()).toMatchObject({ error: null, pollError: 'the server does not answer' });
    away = false;
    await turn();
    expect(page().pollError).toBeNull();
    away = true;
    await turn();
    expect(page().pollError).not.toBeNull();
    away = false;
    await desk.end();
    expect(page().pollError).toBeNull();
  });

  it('keeps the newest list of what is saved, whichever answer comes first', async () => {
    saved = ['old'];
    held = [];
    const first = desk.readLists();
    saved = [];
    const second = desk.remove('old');
    await settle();
    const [older, newer] = held;
    newer?.();
    await second;
    older?.();
    await first;
    expect(page().saved).toEqual([]);
    expect(page().sources).not.toBeNull();
  });

  it('saves the result and uses it in the next flight', async () => {
    await desk.open();
    await desk.begin();
    await desk.save('front');
    const saved = asked.find(({ url, method }) => url === 'api/calibrations' && method === 'POST');
    expect(saved?.body).toEqual({ session: 's1', name: 'front' });
    store.state.scenarioDocument = { camera: { fov_deg: 80, rate_hz: 31 } };
    desk.useInScenario('/up/front.json', 'front');
    const edit = store.state.scenarioEdits.get('camera') ?? '';
    expect(JSON.parse(edit)).toEqual({ calibration: '/up/front.json', rate_hz: 31 });
  });

  it('keeps the changes of the camera when it uses a calibration, and has them checked', () => {
    const { state } = store;
    state.scenarioDocument = { camera: { fov_deg: 80, rate_hz: 31 } };
    state.scenarioEdits = new Map([['camera', '{"fov_deg": 90, "rate_hz": 20, "name": "down"}']]);
    desk.useInScenario('/up/front.json', 'front');
    expect(JSON.parse(state.scenarioEdits.get('camera') ?? '')).toEqual({
      calibration: '/up/front.json',
      rate_hz: 20,
      name: 'down',
    });
    expect(state.scenarioEditor.check).toBe('waiting');
    expect(checks).toHaveLength(1);
  });

  it('leaves a camera that is no JSON to the viewer', () => {
    const { state } = store;
    state.scenarioDocument = { camera: { fov_deg: 80 } };
    state.scenarioEdits = new Map([['camera', '{"fov_deg": 9']]);
    desk.useInScenario('/up/front.json', 'front');
    expect(state.scenarioEdits.get('camera')).toBe('{"fov_deg": 9');
    expect(state.notices.map(({ level, text }) => `${level}: ${text}`)).toEqual([
      expect.stringMatching(/^error: Correct the scenario first: camera is not JSON/u),
    ]);
  });
});
