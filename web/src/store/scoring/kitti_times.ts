// KITTI poses and the file with their times, as one TUM file: an upload keeps no second file.

const kOrthonormal = 1e-2;

/** Lines with something on them that are no comments. */
function dataLines(text: string): string[] {
  return text
    .split(/\r?\n/)
    .map((line) => line.trim())
    .filter((line) => line !== '' && !line.startsWith('#'));
}

/** Whether the first line is a KITTI pose: 12 numbers. @param beginning  of the file */
export function isKitti(beginning: string): boolean {
  const [first = ''] = dataLines(beginning);
  const fields = first.split(/\s+/);
  return fields.length === 12 && fields.every((field) => Number.isFinite(Number(field)));
}

/**
 * Throws an Error that names the line if a pose is none, or if there are not as many times.
 * @param times  one a line [s]; their digits are kept
 */
export function tumFromKitti(poses: string, times: string): string {
  const rows = dataLines(poses);
  const stamps = dataLines(times);
  if (rows.length !== stamps.length) {
    throw new Error(
      `${rows.length} poses, but ${stamps.length} times: there must be one time for each pose`,
    );
  }
  return rows
    .map((row, i) => `${stampOf(stamps[i] ?? '', i + 1)} ${tumPose(row, i + 1).join(' ')}\n`)
    .join('');
}

function stampOf(line: string, number: number): string {
  if (Number.isFinite(Number(line))) return line;
  throw new Error(`time ${number} = ${line.slice(0, 40)} is not a number`);
}

/** Position and quaternion x, y, z, w of the upper 3 x 4 of a transform, row by row. */
function tumPose(row: string, number: number): number[] {
  const m = row.split(/\s+/).map(Number);
  if (m.length !== 12 || !m.every(Number.isFinite)) {
    throw new Error(`pose ${number} does not have 12 numbers`);
  }
  const at = (i: number, k: number) => m[4 * i + k] ?? NaN;
  if (!isRotation(at)) throw new Error(`pose ${number} is not a rotation and a position`);
  return [at(0, 3), at(1, 3), at(2, 3), ...quaternionOf(at)];
}

type Matrix = (row: number, column: number) => number;

/** As the server checks it. */
function isRotation(at: Matrix): boolean {
  let squares = 0;
  for (let i = 0; i < 3; i += 1) {
    for (let k = 0; k < 3; k += 1) {
      const dot = at(0, i) * at(0, k) + at(1, i) * at(1, k) + at(2, i) * at(2, k);
      squares += (dot - (i === k ? 1 : 0)) ** 2;
    }
  }
  const cross = (i: number, k: number) => at(1, i) * at(2, k) - at(2, i) * at(1, k);
  const determinant = at(0, 0) * cross(1, 2) - at(0, 1) * cross(0, 2) + at(0, 2) * cross(0, 1);
  return Math.sqrt(squares) <= kOrthonormal && determinant > 0;
}

/**
 * x, y, z, w, of unit length. Method: Shoemake, Animating Rotation with Quaternion Curves, SIGGRAPH
 * 1985, as the server reads KITTI files; of a matrix with few digits another method gives another
 * rotation.
 */
function quaternionOf(at: Matrix): number[] {
  const trace = at(0, 0) + at(1, 1) + at(2, 2);
  const q = [0, 0, 0, 0];
  if (trace > 0) {
    const root = Math.sqrt(trace + 1);
    const factor = 0.5 / root;
    q[0] = (at(2, 1) - at(1, 2)) * factor;
    q[1] = (at(0, 2) - at(2, 0)) * factor;
    q[2] = (at(1, 0) - at(0, 1)) * factor;
    q[3] = 0.5 * root;
  } else {
    let i = at(1, 1) > at(0, 0) ? 1 : 0;
    if (at(2, 2) > at(i, i)) i = 2;
    const j = (i + 1) % 3;
    const k = (j + 1) % 3;
    const root = Math.sqrt(at(i, i) - at(j, j) - at(k, k) + 1);
    const factor = 0.5 / root;
    q[i] = 0.5 * root;
    q[j] = (at(j, i) + at(i, j)) * factor;
    q[k] = (at(k, i) + at(i, k)) * factor;
    q[3] = (at(k, j) - at(j, k)) * factor;
  }
  const norm = Math.hypot(...q);
  return q.map((part) => part / norm);
}
