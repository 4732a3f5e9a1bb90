import { describe, expect, it } from 'vitest';
import { RestClient } from '../../../src/connection/rest_client';
import { LogWorlds, movedTrack, outlineOf, shareOutside } from '../../../src/store/logs/log_worlds';
import { Store } from '../../../src/store/state';

const kHalf = 0.01;
const kWorld = {
  name: 'Airfield',
  attribution: '',
  centre: { lat_deg: 47, lon_deg: 8 },
  outline: [
    [1, -1],
    [1, 1],
    [-1, 1],
    [-1, -1],
  ].map(([north = 0, east = 0]) => ({
    lat_deg: 47 + north * kHalf,
    lon_deg: 8 + east * kHalf,
  })),
};
// Four kilometres to the east, then one to the north, far away from the world.
const kTrack = {
  t_s: [0, 1, 2],
  east_m: [0, 4000, 4000],
  north_m: [0, 0, 1000],
  origin: { lat_deg: -30, lon_deg: 100 },
};

describe('worlds on the map', () => {
  it('lie where they are, also across the antimeridian', () => {
    const { north_m, east_m } = outlineOf(kWorld, { lat_deg: 47, lon_deg: 8 }, true);
    expect(north_m.map(Math.round)).toEqual([1112, 1112, -1112, -1112]);
    expect(east_m.map(Math.round)).toEqual([-761, 761, 761, -761]);
    const over = { ...kWorld, outline: [{ lat_deg: 0, lon_deg: -179.99 }] };
    const [east = 0] = outlineOf(over, { lat_deg: 0, lon_deg: 179.99 }, false).east_m;
    expect(Math.round(east)).toBe(2226);
  });

  it('get the flight turned, with the middle of the slice in their centre', () => {
    const moved = movedTrack(kTrack, kWorld, 90, null);
    expect(moved.origin).toEqual(kWorld.centre);
    // East becomes south, north becomes east.
    expect(moved.east_m.map(Math.round)).toEqual([-500, -500, 500]);
    expect(moved.north_m.map(Math.round)).toEqual([2000, -2000, -2000]);
    const slice = movedTrack(kTrack, kWorld, 0, [1, 2]);
    expect(slice.east_m).toEqual([-4000, 0, 0]);
    expect(slice.north_m).toEqual([-500, -500, 500]);
  });

  it('state how much of the flight is outside', () => {
    const outline = outlineOf(kWorld, kWorld.centre, true);
    expect(shareOutside(movedTrack(kTrack, kWorld, 0, null), outline, null)).toBe(1);
    expect(shareOutside(movedTrack(kTrack, kWorld, 0, [1, 2]), outline, [1, 2])).toBe(0);
    expect(shareOutside(movedTrack(kTrack, kWorld, 0, [1, 2]), outline, null)).toBeCloseTo(1 / 3);
  });

  it('are read one after another, the chosen one first', async () => {
    const store = new Store();
    const entry = (name: string, error: string | null) => ({
      name,
      title: '',
      description: '',
      error,
      flight: 'course',
      saved: false,
    });
    store.state.scenarios = [entry('a', null), entry('b', 'broken'), entry('c', null)];
    store.state.logPage.open = true;
    store.state.logPage.flight.scenario = 'c';
    const asked: string[] = [];
    const rest = new RestClient('api', (url) => {
      asked.push(url);
      return Promise.resolve(
        asked.length === 1 ? Response.json(kWorld) : new Response('', { status: 409 }),
      );
    });
    const worlds = new LogWorlds(store, rest);
    await Promise.all([worlds.refresh(), worlds.refresh()]);
    await worlds.refresh();
    expect(asked).toEqual(['api/scenarios/c/world', 'api/scenarios/a/world']);
    expect([...store.state.logPage.worlds]).toEqual([
      ['c', kWorld],
      ['a', null],
    ]);
  });
});
