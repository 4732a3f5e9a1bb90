import { beforeEach, describe, expect, it } from 'vitest';
import { kCommand } from '../../../src/store/missions/mission_item';
import { kCourse, MissionBench } from '../../support/mission_bench';
import { kPlan, kWaypoints, sampleWorld } from '../../support/missions';

let bench: MissionBench;
beforeEach(() => (bench = new MissionBench()));

describe('MissionDesk', () => {
  it('begins with an empty mission at the runway of the usual world', async () => {
    const desk = bench.makeDesk();
    await desk.open();
    expect(bench.page.draft).toMatchObject({ base: 'course', world: 'builtin:1', name: null });
    expect(bench.page.draft?.mission.home).toEqual({
      lat_deg: 39.355,
      lon_deg: -86.031,
      alt_msl_m: 228,
    });
    await bench.settle();
    expect(bench.asked.filter(({ url }) => url.includes('report'))).toHaveLength(0);
  });

  it('asks once for a report when edits pause, and ends the request before', async () => {
    const desk = bench.makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    desk.add(kCommand.waypoint, [39.37, -86.03]);
    await bench.settle();
    const reports = () => bench.asked.filter(({ url }) => url.includes('report'));
    expect(reports()).toHaveLength(1);
    const { document } = reports()[0]?.body ?? {};
    expect(document?.flight?.mission).toMatchObject({
      home: 'file',
      airspeed_m_s: 25,
      plan: { fileType: 'Plan' },
    });
    expect(document).toMatchObject({ estimators: kCourse.estimators, camera: kCourse.camera });
    expect(document).not.toHaveProperty('description');
    expect(bench.page.report).not.toBeNull();
    desk.setReport({ camera: 'down' });
    await bench.settle();
    expect(reports()).toHaveLength(2);
    expect(reports()[0]?.signal?.aborted).toBe(true);
  });

  it('shows what the server says is wrong', async () => {
    bench.answers['POST api/missions/report'] = () => [
      400,
      { error: { code: 'invalid_argument', message: 'mission item 1: no' } },
    ];
    const desk = bench.makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    await bench.settle();
    expect(bench.page.errors).toEqual([{ field: '', message: 'mission item 1: no' }]);
    expect(bench.page.report).toBeNull();
  });

  it('undoes and redoes edits', async () => {
    const desk = bench.makeDesk();
    await desk.open();
    desk.add(kCommand.takeOff, [39.36, -86.03]);
    desk.add(kCommand.waypoint, [39.37, -86.03]);
    expect(bench.page.draft?.mission.items).toHaveLength(2);
    desk.remove(bench.page.draft?.mission.items[0]?.id ?? 0);
    desk.undo();
    desk.undo();
    expect(
      bench.page.draft?.mission.items.map((item) => item.kind === 'simple' && item.command),
    ).toEqual([22]);
    expect(bench.page.canRedo).toBe(true);
    desk.redo();
    desk.redo();
    expect(bench.page.draft?.mission.items).toHaveLength(1);
    expect(bench.page.canRedo).toBe(false);
  });

  it('inserts after the selected item', async () => {
    const desk = bench.makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    const first = bench.page.draft?.mission.items[0]?.id ?? 0;
    desk.add(kCommand.waypoint, [39.37, -86.03]);
    desk.select(first);
    desk.add(kCommand.circleTurns, [39.365, -86.03]);
    expect(
      bench.page.draft?.mission.items.map((item) => item.kind === 'simple' && item.command),
    ).toEqual([16, 18, 16]);
    expect(bench.page.selected).toBe(bench.page.draft?.mission.items[1]?.id);
  });

  it('keeps the draft in the browser', async () => {
    const desk = bench.makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    desk.set({ title: 'Über den Hügel' });
    await bench.settle();
    const again = bench.makeDesk();
    await again.open();
    expect(bench.page.draft).toMatchObject({ title: 'Über den Hügel', base: 'course' });
    expect(bench.page.draft?.mission.items).toHaveLength(1);
    await bench.settle();
    expect(bench.page.report).not.toBeNull();
    bench.kept.set('overfly.mission', '{"title": 7}');
    await bench.makeDesk().open();
    expect(bench.page.draft?.mission.items).toHaveLength(0);
  });

  it('saves under a free name, replaces its own, and copies', async () => {
    bench.answers['PUT api/scenarios/uber_den_hugel'] = () => [201, {}];
    bench.answers['PUT api/scenarios/uber_den_hugel_2'] = () => [201, {}];
    const desk = bench.makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    desk.set({ title: 'Über den Hügel' });
    expect(desk.isChanged).toBe(true);
    await desk.save();
    expect(bench.page.errors).toEqual([]);
    expect(bench.page.draft?.name).toBe('uber_den_hugel');
    expect(desk.isChanged).toBe(false);
    bench.store.state.scenarios?.push({
      name: 'uber_den_hugel',
      title: '',
      description: '',
      error: null,
      flight: 'mission',
      saved: true,
    });
    await desk.save();
    await desk.save(true);
    const puts = bench.asked.filter(({ method }) => method === 'PUT').map(({ url }) => url);
    expect(puts).toEqual([
      'api/scenarios/uber_den_hugel',
      'api/scenarios/uber_den_hugel?replace=true',
      'api/scenarios/uber_den_hugel_2',
    ]);
  });

  it('knows after a reload of the page what the mission is saved as', async () => {
    bench.answers['PUT api/scenarios/hill'] = () => [201, {}];
    bench.answers['DELETE api/scenarios/hill'] = () => [204, null];
    const desk = bench.makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    desk.set({ title: 'Hill' });
    await bench.settle();
    await desk.save();
    await bench.makeDesk().open();
    expect(bench.page.draft?.name).toBe('hill');
    await desk.removeScenario('hill');
    await bench.makeDesk().open();
    expect(bench.page.draft).toMatchObject({ title: 'Hill', name: null });
  });

  it('undoes edits, but not that the mission is saved', async () => {
    bench.answers['PUT api/scenarios/hill'] = () => [201, {}];
    bench.answers['GET api/scenarios/other'] = () => [200, { ...kCourse, camera: { rate_hz: 5 } }];
    const desk = bench.makeDesk();
    await desk.open();
    desk.set({ title: 'Hill' });
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    desk.add(kCommand.waypoint, [39.37, -86.03]);
    await desk.save();
    await desk.chooseBase('other');
    desk.undo();
    expect(bench.page.draft?.mission.items).toHaveLength(1);
    expect(bench.page.draft).toMatchObject({
      name: 'hill',
      base: 'other',
      baseDocument: { camera: { rate_hz: 5 } },
    });
    await desk.save();
    const puts = bench.asked.filter(({ method }) => method === 'PUT').map(({ url }) => url);
    expect(puts).toEqual(['api/scenarios/hill', 'api/scenarios/hill?replace=true']);
    expect(bench.page.opened, 'it is one mission').toBe(1);
    await desk.startNew();
    expect(bench.page.opened).toBe(2);
  });

  it('flies the mission and shows its run', async () => {
    const desk = bench.makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    await desk.fly();
    expect(bench.shown).toEqual(['r9']);
    expect(bench.page.open).toBe(false);
    const { body } = bench.asked.find(({ url }) => url === 'api/runs') ?? {};
    expect(body?.document?.name).toBe('mission');
  });

  it('opens the mission of a scenario where it is flown', async () => {
    bench.addPattern();
    const desk = bench.makeDesk();
    await desk.open();
    await desk.openScenario('pattern');
    expect(bench.page.draft).toMatchObject({
      title: 'Pattern',
      name: null,
      flight: { airspeed_m_s: 20, airframe: 'aerosonde' },
    });
    expect(bench.page.draft?.mission.home).toMatchObject({ lat_deg: 39.355, lon_deg: -86.031 });
    expect(bench.page.notes).toContain('Item 6: command 203 is kept, but not flown');
    await bench.settle();
    const { document } = bench.asked.find(({ url }) => url.includes('report'))?.body ?? {};
    expect(document?.flight?.mission).not.toHaveProperty('file');
  });

  it('imports either format and reports what it cannot fly', async () => {
    const desk = bench.makeDesk();
    await desk.open();
    const file = (name: string, text: string) => ({
      name,
      size: text.length,
      text: () => Promise.resolve(text),
    });
    await desk.import(file('a.waypoints', kWaypoints));
    expect(bench.page.notes).toEqual([
      'a.waypoints: 3 items.',
      'Item 3: command 203 is kept, but not flown',
    ]);
    expect(desk.export('waypoints')?.text).toBe(kWaypoints);
    await desk.import(file('b.plan', JSON.stringify(kPlan)));
    expect(JSON.parse(desk.export('plan')?.text ?? '')).toEqual(kPlan);
    await desk.import(file('c.txt', 'nothing'));
    expect(bench.page.notes).toEqual(['c.txt: line 1: must be "QGC WPL 110"']);
    expect(desk.export('plan')?.text).toContain('QGroundControl');
    desk.undo();
    expect(desk.export('waypoints')?.text).toBe(kWaypoints);
    await desk.import({ ...file('d.plan', ''), size: 1e9 });
    expect(bench.page.notes[0]).toContain('must be at most');
  });

  it('makes the built-in world, also if that takes longer than a request may', async () => {
    let made = false;
    bench.answers['GET api/worlds/builtin%3A1'] = () =>
      made ? [200, sampleWorld()] : [409, { error: { code: 'conflict', message: 'not made' } }];
    bench.answers['POST api/worlds/builtin%3A1/make'] = () => {
      made = true;
      return [503, { error: { code: 'timeout', message: 'too long' } }];
    };
    bench.answers['GET api/progress/key-12345'] = () => [
      404,
      { error: { code: 'not_found', message: '' } },
    ];
    const desk = bench.makeDesk();
    await desk.open();
    expect(bench.page.worldMissing).toBe(true);
    await desk.makeWorld();
    expect(bench.page.world?.name).toBe('builtin:1');
    expect(bench.page.draft?.mission.home.lat_deg).toBe(39.355);
  });

  it('offers to move a mission that lies elsewhere', async () => {
    const desk = bench.makeDesk();
    await desk.open();
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    desk.edit((mission) => ({ ...mission, home: { ...mission.home, lat_deg: 10 } }));
    expect(desk.isElsewhere).toBe(true);
    desk.moveToWorld();
    expect(desk.isElsewhere).toBe(false);
  });
});
