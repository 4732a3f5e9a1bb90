import { beforeEach, describe, expect, it } from 'vitest';
import { kNewMission, MissionChoice } from '../../../src/store/missions/mission_choice';
import type { MissionDesk } from '../../../src/store/missions/mission_desk';
import { kCommand } from '../../../src/store/missions/mission_item';
import { MissionBench } from '../../support/mission_bench';

let bench: MissionBench;
let desk: MissionDesk;
let choice: MissionChoice;
let waiting: (() => void)[];

beforeEach(async () => {
  bench = new MissionBench();
  bench.addPattern();
  desk = bench.makeDesk();
  waiting = [];
  choice = new MissionChoice(bench.store, desk, (callback) => waiting.push(callback));
  await desk.open();
});

const items = () => bench.page.draft?.mission.items.length;
const question = 'The mission is not saved: choose again to replace it.';

describe('MissionChoice', () => {
  it('replaces a drawing that is not saved by the second choice of the same mission', async () => {
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    await choice.choose('pattern');
    expect(bench.page.notes).toEqual([question]);
    await choice.choose(kNewMission);
    expect(items(), 'another choice').toBe(1);
    await choice.choose(kNewMission);
    expect(items()).toBe(0);
    expect(bench.page.notes).toEqual([]);
  });

  it('forgets the first choice after a while', async () => {
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    await choice.choose(kNewMission);
    for (const callback of waiting) callback();
    expect(bench.page.notes).toEqual([]);
    await choice.choose(kNewMission);
    expect(items()).toBe(1);
  });

  it('replaces at once what the server has, and an empty mission', async () => {
    bench.answers['PUT api/scenarios/hill'] = () => [201, {}];
    await choice.choose('pattern');
    expect(bench.page.draft?.title).toBe('Pattern');
    expect(desk.isUnsaved).toBe(false);
    await choice.choose(kNewMission);
    expect(bench.page.draft?.title).toBe('');
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    desk.set({ title: 'Hill' });
    expect(desk.isUnsaved).toBe(true);
    await desk.save();
    expect(desk.isUnsaved).toBe(false);
    await choice.choose('pattern');
    expect(bench.page.draft?.title).toBe('Pattern');
    desk.set({ title: 'Mine' });
    expect(desk.isUnsaved).toBe(true);
    desk.undo();
    expect(desk.isUnsaved, 'as it was opened').toBe(false);
  });

  it('keeps the draft of the browser, also if another is chosen before the worlds are listed', async () => {
    desk.add(kCommand.waypoint, [39.36, -86.03]);
    await bench.settle();
    const again = bench.makeDesk();
    const listed = bench.hold('GET api/worlds');
    const opening = again.open();
    await new MissionChoice(bench.store, again, () => undefined).choose('pattern');
    expect(bench.page.notes).toEqual([question]);
    listed();
    await opening;
    expect(items()).toBe(1);
    expect(bench.page.world?.name).toBe('builtin:1');
  });
});
