import { describe, expect, it } from 'vitest';
import { tumFromKitti } from '../../../src/store/scoring/kitti_times';
import { uploadPlan } from '../../../src/store/scoring/upload_plan';

const kIdentity = '1 0 0 4 0 1 0 5 0 0 1 6';
/** Turned by 90 deg about z, and by 180 deg about each axis. */
const kTurned = '0 -1 0 0 1 0 0 0 0 0 1 0';
const kAboutX = '1 0 0 0 0 -1 0 0 0 0 -1 0';
const kAboutY = '-1 0 0 0 0 1 0 0 0 0 -1 0';
const kAboutZ = '-1 0 0 0 0 -1 0 0 0 0 1 0';

function quaternions(poses: string[]): number[][] {
  const times = poses.map((_, i) => String(i)).join('\n');
  const lines = tumFromKitti(poses.join('\n'), times).trimEnd().split('\n');
  return lines.map((line) => line.split(' ').slice(4).map(Number));
}

describe('tumFromKitti', () => {
  it('keeps the digits of the times, and the positions', () => {
    const text = tumFromKitti(
      `# poses\n${kIdentity}\n\n${kIdentity}\n`,
      '1.403636579763555e+9\r\n2.50\r\n',
    );
    expect(text).toBe('1.403636579763555e+9 4 5 6 0 0 0 1\n2.50 4 5 6 0 0 0 1\n');
  });

  it('turns matrices into quaternions, half turns too', () => {
    const [z, x180, y180, z180] = quaternions([kTurned, kAboutX, kAboutY, kAboutZ]);
    const half = Math.SQRT1_2;
    [0, 0, half, half].forEach((part, i) => expect(z?.[i]).toBeCloseTo(part, 15));
    expect(x180?.map(Math.abs)).toEqual([1, 0, 0, 0]);
    expect(y180?.map(Math.abs)).toEqual([0, 1, 0, 0]);
    expect(z180?.map(Math.abs)).toEqual([0, 0, 1, 0]);
  });

  it.each([
    [`${kIdentity}\n${kIdentity}`, '0', '2 poses, but 1 times'],
    [`${kIdentity}\n1 2 3`, '0\n1', 'pose 2 does not have 12 numbers'],
    [kIdentity.replace('1', '-1'), '0', 'pose 1 is not a rotation and a position'],
    [kIdentity.replace('1', '1.1'), '0', 'pose 1 is not a rotation and a position'],
    [`${kIdentity}\n${kIdentity}`, '0\n1.0 2.0', 'time 2 = 1.0 2.0 is not a number'],
  ])('refuses %j with %j', (poses, times, message) => {
    expect(() => tumFromKitti(poses, times)).toThrow(message);
  });
});

const file = (name: string, text = '') => new File([text], name);

describe('uploadPlan', () => {
  it('joins KITTI poses with their times, and leaves the others as they are', async () => {
    const plan = await uploadPlan([
      file('times.txt', '0.5\n'),
      file('00.txt', `${kIdentity}\n`),
      file('e.tum', '0 0 0 0 0 0 0 1\n'),
    ]);
    expect(plan.map(({ kind, name }) => [kind, name])).toEqual([
      ['trajectory', '00.tum'],
      ['trajectory', 'e.tum'],
    ]);
    expect(await plan[0]?.body.text()).toBe('0.5 4 5 6 0 0 0 1\n');
  });

  it('reads no whole file that is too large to be poses', async () => {
    const large = file('00.txt', kIdentity);
    Object.defineProperty(large, 'size', { value: 2 ** 40 });
    const times = file('times.txt', '0.5\n');
    await expect(uploadPlan([times, large])).rejects.toThrow('00.txt: has more than 64 MiB');
    const video = file('e.mp4', 'x');
    Object.defineProperty(video, 'size', { value: 2 ** 40 });
    video.text = () => Promise.reject(new Error('read whole'));
    expect(await uploadPlan([times, file('00.txt', kIdentity), video])).toHaveLength(2);
  });

  it('uploads KITTI poses without times as they are', async () => {
    const [one] = await uploadPlan([file('00.txt', kIdentity)]);
    expect(one).toMatchObject({ kind: 'trajectory', name: '00.txt' });
  });

  it('knows flight logs, and mappings with their CSV files', async () => {
    const plan = await uploadPlan([
      file('a.BIN'),
      file('gps.csv', '12'),
      file('m.json', '{}'),
      file('e.tum'),
    ]);
    expect(plan.map(({ kind, name }) => [kind, name])).toEqual([
      ['trajectory', 'e.tum'],
      ['log', 'm.json'],
      ['log', 'a.BIN'],
    ]);
    expect(plan[1]).toMatchObject({ query: 'files=m.json%3A2%2Cgps.csv%3A2' });
    expect(plan[2]).toMatchObject({ query: 'name=a.BIN' });
    const [csv] = await uploadPlan([file('euroc.csv')]);
    expect(csv?.kind).toBe('trajectory');
  });

  it.each([
    [[file('times.txt', '0')], 'times.txt: choose the KITTI poses'],
    [[file('times.txt', '0'), file('e.tum', '0 0 0 0 0 0 0 1')], 'times.txt: choose the KITTI'],
    [[file('times.txt'), file('00_times.txt')], '00_times.txt: one times file at a time'],
    [[file('times.txt', '0\n1'), file('00.txt', kIdentity)], '00.txt: 1 poses, but 2 times'],
    [[file('m.json')], 'm.json: choose the CSV files'],
  ])('refuses what is incomplete: %#', async (files, message) => {
    await expect(uploadPlan(files)).rejects.toThrow(message);
  });
});
