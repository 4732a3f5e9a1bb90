import { describe, expect, it } from 'vitest';
import { knownMissedFrames, missedFrames } from '../../../src/store/plots/missed_frames';
import { Table } from '../../../src/store/table';

function tableOf(frames: number[]): Table {
  const table = new Table();
  table.write(0, frames.length, { frame: frames, t_ns: frames.map((frame) => frame * 10) });
  return table;
}

const truth = tableOf([0, 1, 2, 3, 4, 5, 6, 7]);

describe('missedFrames', () => {
  it('counts the frames without an answer so far', () => {
    const { t_ns, count } = missedFrames(truth, tableOf([1, 2, 5, 7]), true);
    expect([...t_ns]).toEqual([0, 10, 20, 30, 40, 50, 60, 70]);
    expect([...count]).toEqual([1, 1, 1, 2, 3, 3, 4, 4]);
  });

  it('waits for the answers to the newest frames while the flight goes on', () => {
    const answers = tableOf([0, 1, 3, 4]);
    expect([...missedFrames(truth, answers, false).count]).toEqual([0, 0, 1, 1, 1]);
    expect([...missedFrames(truth, answers, true).count]).toEqual([0, 0, 1, 1, 1, 2, 3, 4]);
  });

  it('counts frames from the truth that there is, also without answers', () => {
    expect([...missedFrames(truth, tableOf([]), false).count]).toEqual([]);
    expect([...missedFrames(tableOf([4, 5]), tableOf([3, 4, 9]), true).count]).toEqual([0, 1]);
  });
});

describe('knownMissedFrames', () => {
  it('counts again when there are more rows', () => {
    const answers = tableOf([0]);
    const first = knownMissedFrames(truth, answers, false, 0);
    expect(knownMissedFrames(truth, answers, false, 0)).toBe(first);
    answers.write(1, 1, { frame: [3], t_ns: [30] });
    expect([...knownMissedFrames(truth, answers, false, 0).count]).toEqual([0, 1, 2, 2]);
  });
});
