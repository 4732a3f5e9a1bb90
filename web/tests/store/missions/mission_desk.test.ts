import { beforeEach, describe, expect, it } from 'vitest';
import { RestClient } from '../../../src/connection/rest_client';
import { MissionDesk } from '../../../src/store/missions/mission_desk';
import { kCommand } from '../../../src/store/missions/mission_item';
import { Store } from '../../../src/store/state';
import { FakeTimers } from '../../support/fake_socket';
import {
  kPlan,
  kWaypoints,
  sampleReport,
  sampleWorld,
  sampleWorldEntry,
} from '../../support/missions';
import { sampleRun } from '../../support/samples';

interface Asked {
  method: string;
  url: string;
  body: { document?: { name?: string; flight?: { mission?: unknown } } } | null;
  signal: AbortSignal | null;
}
type Answer = [number, unknown];

const course = {
  format_version: 1,
  name: 'course',
  title: 'The course',
  description: 'what it is',
  world: { builtin: { seed: 1 } },
  flight: { course: {} },
  camera: { rate_hz: 31 },
  estimators: [{ name: 'feature', type: 'feature' }],
};

let store: Store;
let asked: Asked[];
let answers: Record<string, (body: unknown) => Answer>;
let kept: Map<string, string>;
let timers: FakeTimers;
let shown: (string | null)[];

function makeDesk(): MissionDesk {
  store = new Store();
  store.state.scenarios = [
    {
      name: 'course',
      title: 'Course',
      description: '',
      error: null,
      flight: 'course',
      saved: false,
    },
  ];
  timers = new FakeTimers();
  shown = [];
  const rest = new RestClient('api', (url, init) => {
    const method = init?.method ?? 'GET';
    const body: unknown = typeof init?.body === 'string' ? JSON.parse(init.body) : null;
    asked.push({ method, url, body: body as Asked['body'], signal: init?.signal ?? null });
    const answer = answers[`${method} ${url.replace(/\?.*$/, '')}`];
    if (answer === undefined) return Promise.reject(new TypeError('refused'));
    const [status, document] = answer(body);
    return Promise.resolve(
      new Response(status === 204 ? null : JSON.stringify(document), { status }),
    );
  });
  const storage = {
    getItem: (key: string) => kept.get(key) ?? null,
    setItem: (key: string, value: string) => void kept.set(key, value),
  };
  const later = (callback: () => void, delay_ms: number) => void timers.set(callback, delay_ms);
  const session = { selectRun: (id: string | null) => void shown.push(id) };
  return new MissionDesk(
    store,
    rest,
    session,
    storage,
    later,
    () => 'key-12345',
    () => Promise.resolve(),
  );
}

beforeEach(() => {
  asked = [];
  kept = new Map();
  answers = {
    'GET api/worlds': () => [200, { worlds: [sampleWorldEntry()], complete: true }],
    'GET api/worlds/builtin%3A1': () => [200, sampleWorld()],
    'GET api/scenarios/course': () => [200, course],
    'POST api/missions/report': () => [200, sampleReport()],
    'POST api/runs': () => [201, sampleRun({ id: 'r9' })],
  };
});

const page = () => store.state.missionPage;
const settle = async () => {
  timers.fire();
  await new Promise((resolve) => setTimeout(resolve, 0));
};

describe('MissionDesk', () => {
  it('begins with an empty mission at the runway of the usual world', async () => {
    const desk = makeDesk();
    await desk.open();
    expect(page().draft).toMatchObject({ base: 'course', world: 'builtin:1', name: null });
    expect(page().draft?.mission.home).toEqual({
      lat_deg: 39.355,
      lon_deg: -86.031,
      alt_msl_m: 228,
    });
    await settle();
    expect(asked.filter(({ url }) => url.includes('report'))).toHaveLength(0);
  });

  it('asks once for a report when edits pause, and ends the request before', async () => {
    const desk = makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    desk.add(kCommand.waypoint, [39.37, -86.03]);
    await settle();
    const reports = () => asked.filter(({ url }) => url.includes('report'));
    expect(reports()).toHaveLength(1);
    const { document } = reports()[0]?.body ?? {};
    expect(document?.flight?.mission).toMatchObject({
      home: 'file',
      airspeed_m_s: 25,
      plan: { fileType: 'Plan' },
    });
    expect(document).toMatchObject({ estimators: course.estimators, camera: course.camera });
    expect(document).not.toHaveProperty('description');
    expect(page().report).not.toBeNull();
    desk.setReport({ camera: 'down' });
    await settle();
    expect(reports()).toHaveLength(2);
    expect(reports()[0]?.signal?.aborted).toBe(true);
  });

  it('shows what the server says is wrong', async () => {
    answers['POST api/missions/report'] = () => [
      400,
      { error: { code: 'invalid_argument', message: 'mission item 1: no' } },
    ];
    const desk = makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    await settle();
    expect(page().errors).toEqual([{ field: '', message: 'mission item 1: no' }]);
    expect(page().report).toBeNull();
  });

  it('undoes and redoes edits', async () => {
    const desk = makeDesk();
    await desk.open();
    desk.add(kCommand.takeOff, [39.36, -86.03]);
    desk.add(kCommand.waypoint, [39.37, -86.03]);
    expect(page().draft?.mission.items).toHaveLength(2);
    desk.remove(page().draft?.mission.items[0]?.id ?? 0);
    desk.undo();
    desk.undo();
    expect(
      page().draft?.mission.items.map((item) => item.kind === 'simple' && item.command),
    ).toEqual([22]);
    expect(page().canRedo).toBe(true);
    desk.redo();
    desk.redo();
    expect(page().draft?.mission.items).toHaveLength(1);
    expect(page().canRedo).toBe(false);
  });

  it('inserts after the selected item', async () => {
    const desk = makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    const first = page().draft?.mission.items[0]?.id ?? 0;
    desk.add(kCommand.waypoint, [39.37, -86.03]);
    desk.select(first);
    desk.add(kCommand.circleTurns, [39.365, -86.03]);
    expect(
      page().draft?.mission.items.map((item) => item.kind === 'simple' && item.command),
    ).toEqual([16, 18, 16]);
    expect(page().selected).toBe(page().draft?.mission.items[1]?.id);
  });

  it('keeps the draft in the browser', async () => {
    const desk = makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    desk.set({ title: 'Über den Hügel' });
    await settle();
    const again = makeDesk();
    await again.open();
    expect(page().draft).toMatchObject({ title: 'Über den Hügel', base: 'course' });
    expect(page().draft?.mission.items).toHaveLength(1);
    await settle();
    expect(page().report).not.toBeNull();
    kept.set('overfly.mission', '{"title": 7}');
    await makeDesk().open();
    expect(page().draft?.mission.items).toHaveLength(0);
  });

  it('saves under a free name, replaces its own, and copies', async () => {
    answers['PUT api/scenarios/uber_den_hugel'] = () => [201, {}];
    answers['PUT api/scenarios/uber_den_hugel_2'] = () => [201, {}];
    const desk = makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    desk.set({ title: 'Über den Hügel' });
    expect(desk.isChanged).toBe(true);
    await desk.save();
    expect(page().errors).toEqual([]);
    expect(page().draft?.name).toBe('uber_den_hugel');
    expect(desk.isChanged).toBe(false);
    store.state.scenarios?.push({
      name: 'uber_den_hugel',
      title: '',
      description: '',
      error: null,
      flight: 'mission',
      saved: true,
    });
    await desk.save();
    await desk.save(true);
    const puts = asked.filter(({ method }) => method === 'PUT').map(({ url }) => url);
    expect(puts).toEqual([
      'api/scenarios/uber_den_hugel',
      'api/scenarios/uber_den_hugel?replace=true',
      'api/scenarios/uber_den_hugel_2',
    ]);
  });

  it('flies the mission and shows its run', async () => {
    const desk = makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    await desk.fly();
    expect(shown).toEqual(['r9']);
    expect(page().open).toBe(false);
    const { body } = asked.find(({ url }) => url === 'api/runs') ?? {};
    expect(body?.document?.name).toBe('mission');
  });

  it('opens the mission of a scenario where it is flown', async () => {
    const flight = {
      mission: { file: 'a.plan', home: 'runway', airspeed_m_s: 20, airframe: 'aerosonde' },
    };
    answers['GET api/scenarios/pattern'] = () => [200, { ...course, title: 'Pattern', flight }];
    answers['GET api/scenarios/pattern/plan'] = () => [200, kPlan];
    const desk = makeDesk();
    await desk.open();
    await desk.openScenario('pattern');
    expect(page().draft).toMatchObject({
      title: 'Pattern',
      name: null,
      flight: { airspeed_m_s: 20, airframe: 'aerosonde' },
    });
    expect(page().draft?.mission.home).toMatchObject({ lat_deg: 39.355, lon_deg: -86.031 });
    expect(page().notes).toContain('Item 6: command 203 is kept, but not flown');
    await settle();
    const { document } = asked.find(({ url }) => url.includes('report'))?.body ?? {};
    expect(document?.flight?.mission).not.toHaveProperty('file');
  });

  it('imports either format and reports what it cannot fly', async () => {
    const desk = makeDesk();
    await desk.open();
    const file = (name: string, text: string) => ({
      name,
      size: text.length,
      text: () => Promise.resolve(text),
    });
    await desk.import(file('a.waypoints', kWaypoints));
    expect(page().notes).toEqual([
      'a.waypoints: 3 items.',
      'Item 3: command 203 is kept, but not flown',
    ]);
    expect(desk.export('waypoints')?.text).toBe(kWaypoints);
    await desk.import(file('b.plan', JSON.stringify(kPlan)));
    expect(JSON.parse(desk.export('plan')?.text ?? '')).toEqual(kPlan);
    await desk.import(file('c.txt', 'nothing'));
    expect(page().notes).toEqual(['c.txt: line 1: must be "QGC WPL 110"']);
    expect(desk.export('plan')?.text).toContain('QGroundControl');
    desk.undo();
    expect(desk.export('waypoints')?.text).toBe(kWaypoints);
    await desk.import({ ...file('d.plan', ''), size: 1e9 });
    expect(page().notes[0]).toContain('must be at most');
  });

  it('makes the built-in world, also if that takes longer than a request may', async () => {
    let made = false;
    answers['GET api/worlds/builtin%3A1'] = () =>
      made ? [200, sampleWorld()] : [409, { error: { code: 'conflict', message: 'not made' } }];
    answers['POST api/worlds/builtin%3A1/make'] = () => {
      made = true;
      return [503, { error: { code: 'timeout', message: 'too long' } }];
    };
    answers['GET api/progress/key-12345'] = () => [
      404,
      { error: { code: 'not_found', message: '' } },
    ];
    const desk = makeDesk();
    await desk.open();
    expect(page().worldMissing).toBe(true);
    await desk.makeWorld();
    expect(page().world?.name).toBe('builtin:1');
    expect(page().draft?.mission.home.lat_deg).toBe(39.355);
  });

  it('offers to move a mission that lies elsewhere', async () => {
    const desk = makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    desk.edit((mission) => ({ ...mission, home: { ...mission.home, lat_deg: 10 } }));
    expect(desk.isElsewhere).toBe(true);
    desk.moveToWorld();
    expect(desk.isElsewhere).toBe(false);
  });
});
