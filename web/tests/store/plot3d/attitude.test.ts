import { describe, expect, it } from 'vitest';
import { bodyAxes } from '../../../src/store/plot3d/attitude';

function close(actual: readonly number[], expected: readonly number[]): void {
  actual.forEach((value, i) => expect(value).toBeCloseTo(expected[i] ?? NaN, 9));
}

const half = Math.SQRT1_2;

describe('the axes of an aircraft', () => {
  it('are north, east and down without a turn', () => {
    const { forward, right, down } = bodyAxes({ roll_deg: 0, pitch_deg: 0, yaw_deg: 0 });
    close(forward, [0, 1, 0]);
    close(right, [1, 0, 0]);
    close(down, [0, 0, -1]);
  });

  it('follow the heading, the nose up and the right wing down', () => {
    close(bodyAxes({ roll_deg: 0, pitch_deg: 0, yaw_deg: 90 }).forward, [1, 0, 0]);
    close(bodyAxes({ roll_deg: 0, pitch_deg: 45, yaw_deg: 90 }).forward, [half, 0, half]);
    close(bodyAxes({ roll_deg: 45, pitch_deg: 0, yaw_deg: 90 }).right, [0, -half, -half]);
  });

  it('are a right-handed system in any attitude: down = forward x right', () => {
    const { forward, right, down } = bodyAxes({ roll_deg: 31, pitch_deg: -17, yaw_deg: 222 });
    const [a, b, c] = forward;
    const [d, e, f] = right;
    close(down, [b * f - c * e, c * d - a * f, a * e - b * d]);
    expect(Math.hypot(...forward)).toBeCloseTo(1);
    expect(Math.hypot(...right)).toBeCloseTo(1);
  });
});
