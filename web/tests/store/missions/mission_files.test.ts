import { describe, expect, it } from 'vitest';
import type { Json } from '../../../src/protocol/rest_types';
import { numbersOf, placeOf } from '../../../src/store/missions/mission_item';
import {
  MissionFileError,
  missionFromPlan,
  notFlown,
  planFromMission,
  planText,
  readPlanText,
} from '../../../src/store/missions/plan_file';
import { readWaypoints, writeWaypoints } from '../../../src/store/missions/waypoints_file';
import { kPlan, kWaypoints, simple } from '../../support/missions';

const ids = () => {
  let next = 1;
  return () => next++;
};
const read = (plan: unknown) => missionFromPlan(plan as Json, ids());

describe('plans of QGroundControl', () => {
  it('survive being read and written: nothing is lost', () => {
    const mission = read(kPlan);
    expect(planFromMission(mission)).toEqual(kPlan);
    expect(JSON.parse(planText(mission))).toEqual(kPlan);
    expect(planFromMission(readPlanText(planText(mission), ids()))).toEqual(kPlan);
  });

  it('number items as they are flown: a survey counts its own', () => {
    const mission = read(kPlan);
    expect(numbersOf(mission)).toEqual([1, 2, 3, 5, 6, 7]);
    expect(mission.items.map((item) => placeOf(item)?.[0] ?? null)).toEqual([
      39.352675,
      null,
      null,
      39.346365,
      null,
      null,
    ]);
  });

  it('tell what is kept but not flown', () => {
    expect(notFlown(read(kPlan))).toEqual([
      'Item 6: command 203 is kept, but not flown',
      'The geofence (1) is kept, but not observed',
      'The rally points (1) are kept, but not used',
    ]);
  });

  it('count jumps again after an item was removed', () => {
    const mission = read(kPlan);
    const fewer = { ...mission, items: mission.items.slice(1) };
    const plan = planFromMission(fewer)['mission'] as { items: { doJumpId?: number }[] };
    expect(plan.items.map(({ doJumpId }) => doJumpId)).toEqual([1, undefined, 4, 5, 6]);
  });

  it.each([
    ['{', 'is no JSON'],
    ['[]', 'fileType'],
    ['{"fileType": "Plan"}', 'mission: must be an object'],
    ['{"fileType": "Plan", "mission": {"version": 1}}', 'mission.version = 1: must be 2'],
    [
      '{"fileType": "Plan", "mission": {"version": 2, "items": 1}}',
      'mission.items: must be an array',
    ],
    [
      '{"fileType": "Plan", "mission": {"version": 2, "items": []}}',
      'mission.plannedHomePosition: must be',
    ],
  ])('refuse %s', (text, message) => {
    expect(() => readPlanText(text, ids())).toThrow(message);
    expect(() => readPlanText(text, ids())).toThrow(MissionFileError);
  });

  it.each([
    [simple(16, 3, [0, 0, 0, 0, 91, 0, 0], 1), 'is no place on the earth'],
    [simple(16, 3, [0, 0], 1), 'mission.items.0.params: must be 7 numbers or null'],
    [{ type: 'SimpleItem' }, 'mission.items.0: must have a command and a frame'],
    [{ type: 'Other' }, 'mission.items.0.type'],
  ])('refuse the item %j', (item, message) => {
    const plan = { ...kPlan, mission: { ...kPlan.mission, items: [item] } };
    expect(() => read(plan)).toThrow(message);
  });
});

describe('missions as text', () => {
  it('survive being read and written', () => {
    const { text, lost } = writeWaypoints(readWaypoints(kWaypoints, ids()));
    expect(text).toBe(kWaypoints);
    expect(lost).toEqual([]);
  });

  it('give the same items as a plan', () => {
    const mission = readWaypoints(kWaypoints, ids());
    const again = missionFromPlan(planFromMission(mission) as Json, ids());
    expect(again.home).toEqual(mission.home);
    expect(again.items).toMatchObject(mission.items.map(({ id, kind }) => ({ id, kind })));
    expect(writeWaypoints(again).text).toBe(kWaypoints);
  });

  it('expand surveys, and say what they cannot hold', () => {
    const { text, lost } = writeWaypoints(read(kPlan));
    expect(text.trim().split('\n')).toHaveLength(9);
    expect(lost).toEqual([
      'that 2 waypoints belong to the item "survey"',
      'the geofence (1)',
      'the rally points (1)',
    ]);
    expect(readWaypoints(text, ids()).items).toHaveLength(7);
  });

  it.each([
    ['QGC WPL 120\n', 'line 1: must be "QGC WPL 110"'],
    ['QGC WPL 110\n', '0 items: must be in [1, 5000]'],
    ['QGC WPL 110\n0 1 0 16 0\n', 'line 2: 5 columns: must be 12'],
    ['QGC WPL 110\n1 1 0 16 0 0 0 0 0 0 0 1\n', 'line 2, column 1 = 1: must be 0'],
    ['QGC WPL 110\n0 1 0 16 0 0 0 0 x 0 0 1\n', 'line 2, column 9 = x: must be a number'],
    ['QGC WPL 110\n0 1 0 16 0 0 0 0 0 200 0 1\n', 'line 2: 0, 200: is no place on the earth'],
  ])('refuse %j', (text, message) => {
    expect(() => readWaypoints(text, ids())).toThrow(message);
  });

  it('read "nan" as the vehicle\'s default', () => {
    const text = 'QGC WPL 110\r\n0 1 0 16 0 0 0 nan 1 2 3 1\r\n1 0 3 16 0 0 0 NaN 1 2 3 1\r\n';
    const [item] = readWaypoints(text, ids()).items;
    expect(item).toMatchObject({ params: [0, 0, 0, null, 1, 2, 3] });
  });
});
