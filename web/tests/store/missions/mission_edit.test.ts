import { describe, expect, it } from 'vitest';
import { metresPerDegree } from '../../../src/store/metres_per_degree';
import { History } from '../../../src/store/missions/history';
import {
  indexAfter,
  inserted,
  movedTo,
  neighbour,
  newItem,
  nudged,
  placed,
  removed,
  reordered,
  withCommand,
  withFrame,
} from '../../../src/store/missions/mission_edit';
import type { Mission, SimpleItem } from '../../../src/store/missions/mission_item';
import { itemOfNumber, kCommand, kFrame, placeOf } from '../../../src/store/missions/mission_item';
import { emptyMission } from '../../../src/store/missions/plan_file';

const home = { lat_deg: 39.35, lon_deg: -86.03, alt_msl_m: 230 };

function missionOf(...commands: number[]): Mission {
  return commands.reduce(
    (mission, command, i) =>
      inserted(mission, i, newItem(mission, i, i + 1, command, [39.35 + 0.01 * i, -86.03])),
    emptyMission(home),
  );
}
const itemAt = (mission: Mission, i: number) => mission.items[i] as { id: number } & SimpleItem;

describe('edits of a mission', () => {
  it('take the height of the item before', () => {
    const mission = missionOf(kCommand.takeOff, kCommand.waypoint);
    expect(itemAt(mission, 0)).toMatchObject({
      frame: kFrame.aboveHome,
      params: [15, 0, 0, null, 39.35, -86.03, 60],
    });
    expect(itemAt(mission, 1)).toMatchObject({ frame: kFrame.aboveGround });
    const lower = { ...itemAt(mission, 1), params: [0, 0, 0, null, 39.36, -86.03, 120] };
    const changed = { ...mission, items: [itemAt(mission, 0), lower] };
    const next = newItem(changed, 2, 9, kCommand.circleTurns, [39.4, -86.03]);
    expect(next).toMatchObject({
      frame: kFrame.aboveGround,
      params: [1, 0, 120, null, 39.4, -86.03, 120],
    });
    expect(newItem(changed, 2, 9, kCommand.land, [39.4, -86.03])).toMatchObject({
      frame: kFrame.aboveHome,
      params: [0, 0, 0, null, 39.4, -86.03, 0],
    });
  });

  it('leave the mission before as it was', () => {
    const mission = missionOf(kCommand.waypoint, kCommand.waypoint, kCommand.waypoint);
    const text = JSON.stringify(mission);
    placed(mission, 2, [1, 2]);
    removed(mission, 1);
    reordered(mission, 1, 2);
    movedTo(mission, [10, 20]);
    expect(JSON.stringify(mission)).toBe(text);
  });

  it('move, reorder and remove', () => {
    const mission = missionOf(kCommand.waypoint, kCommand.waypoint, kCommand.waypoint);
    expect(placeOf(itemAt(placed(mission, 2, [1.123456789, 2]), 1))).toEqual([1.12345679, 2]);
    expect(reordered(mission, 1, 1).items.map(({ id }) => id)).toEqual([2, 1, 3]);
    expect(reordered(mission, 1, -1)).toBe(mission);
    expect(removed(mission, 2).items.map(({ id }) => id)).toEqual([1, 3]);
    const [lat = 0, lon = 0] = placeOf(itemAt(nudged(mission, 1, 100, -50), 0)) ?? [];
    expect((lat - 39.35) * metresPerDegree(39.35).north).toBeCloseTo(-50, 2);
    expect((lon + 86.03) * metresPerDegree(39.35).east).toBeCloseTo(100, 2);
  });

  it('keep the shape when a mission moves to another latitude', () => {
    let mission = missionOf(kCommand.waypoint, kCommand.waypoint);
    mission = placed(mission, 2, [39.35, -86.02]);
    const moved = movedTo(mission, [60, 10]);
    expect(moved.home).toMatchObject({ lat_deg: 60, lon_deg: 10 });
    const east_m = (item: SimpleItem, lon: number, lat: number) =>
      ((placeOf({ id: 0, ...item })?.[1] ?? 0) - lon) * metresPerDegree(lat).east;
    expect(east_m(itemAt(moved, 1), 10, 60)).toBeCloseTo(
      east_m(itemAt(mission, 1), -86.03, 39.35),
      1,
    );
  });

  it('change the type and keep place and height', () => {
    const mission = missionOf(kCommand.waypoint);
    const circle = itemAt(withCommand(mission, 1, kCommand.circleTime), 0);
    expect(circle).toMatchObject({
      id: 1,
      command: kCommand.circleTime,
      params: [60, 0, 120, null, 39.35, -86.03, 300],
    });
    const speed = withCommand(mission, 1, kCommand.speed);
    expect(itemAt(speed, 0)).toMatchObject({ frame: 2, params: [0, 20, -1, 0, 0, 0, 0] });
    // It gets a place again: home's.
    expect(placeOf(itemAt(withCommand(speed, 1, kCommand.waypoint), 0))).toEqual([39.35, -86.03]);
  });

  it('count heights from elsewhere without moving the item', () => {
    const mission = missionOf(kCommand.waypoint);
    const heights = { above_ground_m: 300, above_home_m: 323 };
    const home = itemAt(withFrame(mission, 1, kFrame.aboveHome, heights), 0);
    expect(home).toMatchObject({ frame: kFrame.aboveHome });
    expect(home.params[6]).toBe(323);
    const sea = itemAt(withFrame(mission, 1, kFrame.seaLevel, heights), 0);
    // 323 m above home, whose height above sea level is stated as 230 m.
    expect(sea.params[6]).toBe(553);
    expect(itemAt(withFrame(mission, 1, kFrame.aboveHome, null), 0).params[6]).toBe(300);
  });

  it('find places in the order', () => {
    const mission = missionOf(kCommand.waypoint, kCommand.waypoint);
    expect(indexAfter(mission, 1)).toBe(1);
    expect(indexAfter(mission, null)).toBe(2);
    expect(neighbour(mission, 1, 1)).toBe(2);
    expect(neighbour(mission, 2, 1)).toBe(2);
    expect(neighbour(mission, null, 1)).toBe(1);
    expect(neighbour(emptyMission(home), null, 1)).toBeNull();
    expect(itemOfNumber(mission, 2)?.id).toBe(2);
    expect(itemOfNumber(mission, 3)).toBeNull();
  });
});

describe('History', () => {
  it('undoes and redoes', () => {
    const history = new History<number>();
    history.record(1);
    history.record(2);
    expect(history.undo(3)).toBe(2);
    expect(history.undo(2)).toBe(1);
    expect(history.undo(1)).toBeNull();
    expect(history.redo(1)).toBe(2);
    expect(history.canRedo).toBe(true);
    history.record(2);
    expect(history.canRedo).toBe(false);
  });

  it('takes edits of one kind for one step', () => {
    const history = new History<string>();
    history.record('', 'title');
    history.record('a', 'title');
    history.record('ab', 'height');
    expect(history.undo('abc')).toBe('ab');
    expect(history.undo('ab')).toBe('');
  });

  it('keeps the last 200 steps', () => {
    const history = new History<number>();
    for (let i = 0; i < 300; i += 1) history.record(i);
    let steps = 0;
    while (history.undo(0) !== null) steps += 1;
    expect(steps).toBe(200);
  });
});
