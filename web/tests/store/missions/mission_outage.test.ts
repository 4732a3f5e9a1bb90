// The page of missions works again when a server that was away is back.
import { beforeEach, describe, expect, it } from 'vitest';
import type { MissionDesk } from '../../../src/store/missions/mission_desk';
import { kCommand } from '../../../src/store/missions/mission_item';
import { MissionBench } from '../../support/mission_bench';

const kWorlds = 'GET api/worlds';
const kWorld = 'GET api/worlds/builtin%3A1';
const kReport = 'POST api/missions/report';

let bench: MissionBench;
let desk: MissionDesk;
let away: Partial<MissionBench['answers']>;

beforeEach(async () => {
  bench = new MissionBench();
  desk = bench.makeDesk();
  await desk.open();
  desk.add(kCommand.waypoint, [39.36, -86.03]);
  await bench.settle();
});

function leave(...questions: string[]): void {
  away = Object.fromEntries(questions.map((question) => [question, bench.answers[question]]));
  for (const question of questions) Reflect.deleteProperty(bench.answers, question);
}

function comeBack(): void {
  Object.assign(bench.answers, away);
}

describe('MissionDesk after an outage', () => {
  it('opens the world of the draft when the page is opened again', async () => {
    leave(kWorlds, kWorld);
    desk = bench.makeDesk();
    await desk.open();
    expect(bench.page).toMatchObject({ world: null, worldError: 'the server does not answer' });
    desk.close();
    comeBack();
    await desk.open();
    expect(bench.page.worldError).toBeNull();
    await bench.settle();
    expect(bench.page.report).not.toBeNull();
  });

  it('forgets why the worlds could not be listed once they are', async () => {
    leave(kWorlds);
    await desk.open();
    expect(bench.page).toMatchObject({ listError: 'the server does not answer', worldError: null });
    comeBack();
    await desk.open();
    expect(bench.page.listError).toBeNull();
  });

  it('asks again for the report while the server is away, without an edit', async () => {
    leave(kReport);
    desk.setReport({ camera: 'down' });
    await bench.settle();
    expect(bench.page.report).toBeNull();
    expect(bench.page.errors).toEqual([{ field: '', message: 'the server does not answer' }]);
    await bench.settle();
    comeBack();
    await bench.settle();
    expect(bench.page.report).not.toBeNull();
    expect(bench.page.errors).toEqual([]);
    const asked = bench.asked.length;
    await bench.settle();
    expect(bench.asked).toHaveLength(asked);
  });

  it('asks no second time for a report that takes too long', async () => {
    bench.answers[kReport] = () => [503, { error: { code: 'timeout', message: 'too long' } }];
    desk.setReport({ camera: 'down' });
    await bench.settle();
    const asked = bench.asked.length;
    await bench.settle();
    expect(bench.page.errors).toEqual([{ field: '', message: 'too long' }]);
    expect(bench.asked).toHaveLength(asked);
  });
});
