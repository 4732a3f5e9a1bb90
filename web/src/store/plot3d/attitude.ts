// The attitude of an aircraft in the 3D plot.
import type { Point3 } from './axis_box';

export interface Attitude {
  roll_deg: number;
  pitch_deg: number;
  yaw_deg: number;
}

/** The axes of the body in east-north-up. */
export interface BodyAxes {
  forward: Point3;
  right: Point3;
  down: Point3;
}

/** From intrinsic Z-Y-X angles of the body (forward-right-down) relative to north-east-down. */
export function bodyAxes({ roll_deg, pitch_deg, yaw_deg }: Attitude): BodyAxes {
  const [sr, cr] = sinCos(roll_deg);
  const [sp, cp] = sinCos(pitch_deg);
  const [sy, cy] = sinCos(yaw_deg);
  // The columns of R_ned_body = Rz(yaw) Ry(pitch) Rx(roll).
  return {
    forward: enuFromNed(cy * cp, sy * cp, -sp),
    right: enuFromNed(cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr),
    down: enuFromNed(cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr),
  };
}

function enuFromNed(north: number, east: number, down: number): Point3 {
  return [east, north, -down];
}

function sinCos(angle_deg: number): [number, number] {
  const angle_rad = (angle_deg * Math.PI) / 180;
  return [Math.sin(angle_rad), Math.cos(angle_rad)];
}
