import { describe, expect, it } from 'vitest';
import { bodyAxes } from '../../../src/store/plot3d/attitude';
import { aircraftShape } from '../../../src/views/plot3d/marks_painter';
import { rgbOf } from '../../../src/views/plot3d/rgb';

const fromAbove = {
  target: [0, 0, 0] as const,
  azimuth_rad: 0,
  elevation_rad: Math.PI / 2,
  m_per_px: 1,
};
const width = (points: [number, number][], axis: 0 | 1) =>
  Math.max(...points.map((point) => point[axis])) - Math.min(...points.map((point) => point[axis]));

describe('the shape of an aircraft', () => {
  it('points to its heading, half its length from its place', () => {
    const east = aircraftShape(bodyAxes({ roll_deg: 0, pitch_deg: 0, yaw_deg: 90 }), fromAbove, 10);
    const [nose] = east.plan;
    expect(nose?.[0]).toBeCloseTo(10);
    expect(nose?.[1]).toBeCloseTo(0);
    expect(width(east.plan, 1)).toBeCloseTo(21);
    expect(east.fromAbove).toBe(true);
  });

  it('shows its bank', () => {
    const banked = bodyAxes({ roll_deg: 60, pitch_deg: 0, yaw_deg: 0 });
    const { plan, fin } = aircraftShape(banked, fromAbove, 10);
    expect(width(plan, 0)).toBeCloseTo(10.5);
    // The fin leans to the lower wing.
    expect(Math.max(...fin.map(([x]) => x))).toBeCloseTo(4.2 * Math.sin(Math.PI / 3));
    const over = bodyAxes({ roll_deg: 180, pitch_deg: 0, yaw_deg: 0 });
    expect(aircraftShape(over, fromAbove, 10).fromAbove).toBe(false);
  });
});

describe('a colour of the style sheet', () => {
  it('is read as numbers', () => {
    expect(rgbOf('rgb(255, 0, 51)')).toEqual([1, 0, 0.2]);
    expect(rgbOf('rgba(0, 255, 0, 0.5)')).toEqual([0, 1, 0]);
  });
});
