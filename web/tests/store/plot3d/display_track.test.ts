import { describe, expect, it } from 'vitest';
import { DisplayTrack, kGap_s, kPointSize } from '../../../src/store/plot3d/display_track';
import { Table } from '../../../src/store/table';

type Place = [number, number, number] | null;

/** A row every 0.1 s; null = no pose. */
function write(table: Table, places: Place[]): void {
  const first = table.length;
  const column = (axis: number) => places.map((place) => place?.[axis] ?? null);
  table.write(first, places.length, {
    t_ns: places.map((_, i) => (first + i) * 1e8),
    x_m: column(0),
    y_m: column(1),
    z_m: column(2),
  });
}

function trackOf(places: Place[], most: number): DisplayTrack {
  const table = new Table();
  write(table, places);
  const track = new DisplayTrack(table);
  track.extend(most);
  return track;
}

function pointsOf({ points, count }: DisplayTrack): number[][] {
  return Array.from({ length: count }, (_, i) => [
    ...points.subarray(i * kPointSize, (i + 1) * kPointSize),
  ]);
}

const circle = (from: number, to: number): Place[] =>
  Array.from({ length: to - from }, (_, i) => {
    const angle_rad = (from + i) * 0.01;
    return [100 * Math.sin(angle_rad), 100 * Math.cos(angle_rad), 300];
  });

describe('a track of the 3D plot', () => {
  it('has every pose of a short track, with its time and length', () => {
    const track = trackOf(
      [
        [0, 0, 10],
        [3, 4, 10],
        [3, 4, 22],
      ],
      100,
    );
    expect(pointsOf(track)).toEqual([
      [0, 0, 10, 0, 0],
      [3, 4, 10, Math.fround(0.1), 5],
      [3, 4, 22, Math.fround(0.2), 17],
    ]);
    expect(track.box).toEqual({ min: [0, 0, 10], max: [3, 4, 22] });
  });

  it('is broken where there is no pose, or one of a diverged estimate', () => {
    const track = trackOf(
      [null, [0, 0, 0], [1, 0, 0], null, null, [5, 0, 0], [1e9, 0, 0], [6, 0, 0]],
      100,
    );
    const points = pointsOf(track);
    expect(points.map(([x, , , t_s]) => (t_s === kGap_s ? null : x))).toEqual([
      0,
      1,
      null,
      5,
      null,
      6,
    ]);
    expect(points.map(([, , , , length_m]) => length_m)).toEqual([0, 1, 0, 0, 0, 0]);
    expect(track.box?.max).toEqual([6, 0, 0]);
  });

  it('keeps few points of a long one, near all of its poses', () => {
    const places = circle(0, 5000);
    const track = trackOf(places, 500);
    expect(track.count).toBeLessThanOrEqual(500);
    expect(track.count).toBeGreaterThan(200);
    const points = pointsOf(track);
    expect(points[0]?.[3]).toBe(0);
    expect(points.at(-1)?.[3]).toBeCloseTo(499.9, 3);
    // Blocks of 32 rows, of which the middle one remains: 16 m of an arc of 100 m radius.
    for (let i = 1; i < points.length; i += 1) {
      const [a, b] = [points[i - 1] ?? [], points[i] ?? []];
      const middle = Math.hypot(((a[0] ?? 0) + (b[0] ?? 0)) / 2, ((a[1] ?? 0) + (b[1] ?? 0)) / 2);
      expect(100 - middle).toBeLessThan(16 ** 2 / 800 + 0.05);
    }
  });

  it('keeps a spike', () => {
    const places: Place[] = Array.from({ length: 4000 }, (_, i) => [i, i === 1234 ? 50 : 0, 0]);
    expect(pointsOf(trackOf(places, 100)).some(([x, y]) => x === 1234 && y === 50)).toBe(true);
  });

  it('is the same whether it grew or was there at once', () => {
    const table = new Table();
    const track = new DisplayTrack(table);
    let first = 0;
    for (let rows = 0; rows < 3000; rows += 7) {
      write(table, circle(rows, rows + 7));
      first = track.extend(400);
    }
    const whole = new DisplayTrack(table);
    whole.extend(400);
    expect(pointsOf(track)).toEqual(pointsOf(whole));
    expect(track.box).toEqual(whole.box);
    // Only the points of the last, incomplete block may change.
    expect(track.count - first).toBeLessThanOrEqual(2);
    expect(first).toBeGreaterThan(100);
  });

  it('begins again after its rows were taken back', () => {
    const table = new Table();
    write(table, circle(0, 50));
    const track = new DisplayTrack(table);
    track.extend(100);
    table.write(0, 2, { t_ns: [0, 1e8], x_m: [7, 8], y_m: [0, 0], z_m: [0, 0] });
    expect(track.extend(100)).toBe(0);
    expect(pointsOf(track).map(([x]) => x)).toEqual([7, 8]);
    expect(track.box?.min).toEqual([7, 0, 0]);
  });
});
