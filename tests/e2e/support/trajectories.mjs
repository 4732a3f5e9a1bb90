// Trajectories made by hand, as files of the usual formats.

/** Hamilton product of quaternions x, y, z, w. */
function product([ax, ay, az, aw], [bx, by, bz, bw]) {
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

function turn(axis, angle_rad) {
  const q = [0, 0, 0, Math.cos(angle_rad / 2)];
  q[axis] = Math.sin(angle_rad / 2);
  return q;
}

const rad = (deg) => (deg * Math.PI) / 180;

/** A winding circuit at about 25 m/s in rolling height, seen by a camera that looks down. */
export function poseAt(t_s) {
  const angle = t_s / 24;
  const position = [
    600 * Math.sin(angle) + 30 * Math.sin(0.31 * t_s),
    600 * (1 - Math.cos(angle)),
    300 + 40 * Math.sin(0.11 * t_s),
  ];
  const down = turn(0, Math.PI);
  const attitude = product(turn(2, -angle), turn(1, rad(8) * Math.sin(0.2 * t_s)));
  return { t_s, position, rotation: product(attitude, down) };
}

/** Poses at 10 Hz from a time that is no round number. */
export function flown(duration_s, pose = poseAt) {
  return Array.from({ length: duration_s * 10 }, (_, i) => pose(1000.25 + i / 10));
}

/**
 * An estimate with slow errors of decimetres and tenths of a degree.
 * @param scale metres per unit; clock_s what its clock is early by; mount_deg the camera's turn
 */
export function estimated({ scale = 1, clock_s = 0, mount_deg = 0 }) {
  return (t_s) => {
    const { position, rotation } = poseAt(t_s + clock_s);
    const off_m = [0.7, 1.3, 2.1].map((rate, i) => 0.2 * Math.sin(rate * t_s + i));
    const wobble = turn(1, rad(0.2) * Math.sin(0.9 * t_s));
    return {
      t_s,
      position: position.map((value, i) => (value + off_m[i]) / scale),
      rotation: product(product(rotation, wobble), turn(2, rad(mount_deg))),
    };
  };
}

const lines = (rows) => rows.map((row) => `${row}\n`).join('');

export function tumText(poses) {
  return lines(
    poses.map(({ t_s, position, rotation }) =>
      [t_s.toFixed(6), ...position, ...rotation].join(' '),
    ),
  );
}

export function eurocText(poses) {
  const rows = poses.map(({ t_s, position, rotation: [x, y, z, w] }) =>
    [BigInt(Math.round(t_s * 1e6)) * 1000n, ...position, w, x, y, z].join(','),
  );
  return lines(['#timestamp, p_RS_R_x [m], p_y, p_z, q_RS_w [], q_x, q_y, q_z', ...rows]);
}

/** The upper 3 x 4 of each transform; the times are a file of their own. */
export function kittiTexts(poses) {
  const rows = poses.map(({ position: [px, py, pz], rotation: [x, y, z, w] }) =>
    [
      [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), px],
      [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), py],
      [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), pz],
    ]
      .flat()
      .join(' '),
  );
  return { poses: lines(rows), times: lines(poses.map(({ t_s }) => t_s.toExponential(9))) };
}
