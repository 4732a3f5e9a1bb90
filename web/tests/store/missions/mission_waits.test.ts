// What comes late from the server must not replace what was chosen or edited meanwhile.
import { beforeEach, describe, expect, it } from 'vitest';
import { kCommand } from '../../../src/store/missions/mission_item';
import { MissionBench } from '../../support/mission_bench';
import { sampleWorldEntry } from '../../support/missions';

let bench: MissionBench;
beforeEach(() => (bench = new MissionBench()));

describe('MissionDesk with a slow server', () => {
  it('keeps what is edited while it is saved', async () => {
    bench.answers['PUT api/scenarios/hill'] = () => [201, {}];
    const go = bench.hold('PUT api/scenarios/hill');
    const desk = bench.makeDesk();
    await desk.open();
    desk.set({ title: 'Hill' });
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    const saving = desk.save();
    desk.add(kCommand.waypoint, [39.37, -86.03]);
    desk.set({ title: 'Hill and farm' });
    go();
    await saving;
    expect(bench.page.draft).toMatchObject({ name: 'hill', title: 'Hill and farm' });
    expect(bench.page.draft?.mission.items).toHaveLength(2);
    expect(desk.isChanged, 'the server has the mission before').toBe(true);
  });

  it('gives a mission that was opened meanwhile nothing of the one that is saved', async () => {
    bench.answers['PUT api/scenarios/hill'] = () => [201, {}];
    bench.addPattern();
    const go = bench.hold('PUT api/scenarios/hill');
    const desk = bench.makeDesk();
    await desk.open();
    desk.set({ title: 'Hill' });
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    const saving = desk.save();
    await desk.openScenario('pattern');
    go();
    await saving;
    expect(bench.page.draft).toMatchObject({ name: null, title: 'Pattern' });
    expect(bench.page.savedText).toBeNull();
  });

  it('opens the scenario that was chosen last, whichever is read first', async () => {
    bench.addPattern();
    const go = bench.hold('GET api/scenarios/pattern');
    const desk = bench.makeDesk();
    await desk.open();
    const slow = desk.openScenario('pattern');
    await desk.startNew();
    desk.set({ title: 'Mine' });
    go();
    await slow;
    expect(bench.page.draft).toMatchObject({ title: 'Mine', base: 'course' });
    expect(bench.page.working).toBe(false);
  });

  it('opens a mission that is chosen before the worlds are listed', async () => {
    bench.addPattern();
    const listed = bench.hold('GET api/worlds');
    const read = bench.hold('GET api/scenarios/pattern');
    const desk = bench.makeDesk();
    const opening = desk.open();
    const chosen = desk.openScenario('pattern');
    listed();
    await opening;
    read();
    await chosen;
    expect(bench.page.draft?.title).toBe('Pattern');
  });

  it('keeps what is edited while the world of a mission is opened', async () => {
    bench.addPattern();
    const desk = bench.makeDesk();
    bench.store.state.scenarios?.push({
      name: 'pattern',
      title: 'Pattern',
      description: '',
      error: null,
      flight: 'mission',
      saved: true,
    });
    const go = bench.hold('GET api/worlds/builtin%3A1');
    bench.page.worlds = [sampleWorldEntry()];
    const opening = desk.openScenario('pattern');
    await bench.settle();
    desk.set({ title: 'Edited' });
    go();
    await opening;
    expect(bench.page.draft).toMatchObject({ title: 'Edited', name: 'pattern' });
    // Where the scenario flies it, all the same.
    expect(bench.page.draft?.mission.home).toMatchObject({ lat_deg: 39.355, lon_deg: -86.031 });
    expect(desk.isChanged).toBe(true);
    desk.set({ title: 'Pattern' });
    expect(desk.isChanged, 'as it is on the server').toBe(false);
  });

  it('shows nothing of a world that is not wanted any more', async () => {
    const entry = sampleWorldEntry({ name: 'hills', scenarios: [] });
    bench.answers['GET api/worlds'] = () => [200, { worlds: [sampleWorldEntry(), entry] }];
    bench.answers['GET api/worlds/hills'] = () => [
      500,
      { error: { code: 'internal', message: 'no' } },
    ];
    const go = bench.hold('GET api/worlds/hills');
    const desk = bench.makeDesk();
    await desk.open();
    const slow = desk.chooseWorld('hills');
    await desk.chooseWorld('builtin:1');
    go();
    await slow;
    expect(bench.page.world?.name).toBe('builtin:1');
    expect(bench.page.worldError).toBeNull();
  });
});
