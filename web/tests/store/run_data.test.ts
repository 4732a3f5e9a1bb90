import { describe, expect, it } from 'vitest';
import { RunData } from '../../src/store/run_data';

const truth = (seq: number, frames: number[]) => ({
  stream: 'truth',
  seq,
  columns: { frame: frames, t_ns: frames.map((k) => k * 10) },
});

describe('RunData', () => {
  it('appends rows and counts them for resuming', () => {
    const data = new RunData();
    expect(data.apply(truth(0, [0, 1]))).toBe(true);
    expect(data.apply(truth(2, [2]))).toBe(true);
    expect(
      data.apply({
        stream: 'estimate/a',
        seq: 0,
        columns: { frame: [0], t_ns: [0], state: ['LOST'], x_m: [null] },
      }),
    ).toBe(true);
    data.apply({ stream: 'log', seq: 0, columns: { t_ns: [1], level: ['info'], text: ['hi'] } });
    expect(data.resume()).toEqual({ truth: 3, 'estimate/a': 1, log: 1 });
    expect(data.estimates.get('a')?.states).toEqual(['LOST']);
    expect(data.log).toEqual([{ t_ns: 1, level: 'info', text: 'hi', kind: '', source: '' }]);
    expect(data.generation).toBe(0);
  });

  it('refuses rows behind a gap and keeps what it has', () => {
    const data = new RunData();
    data.apply(truth(0, [0]));
    expect(data.apply(truth(2, [2]))).toBe(false);
    expect(data.truth.length).toBe(1);
  });

  it('takes rows sent again as the truth', () => {
    const data = new RunData();
    data.apply(truth(0, [0, 1, 2]));
    data.apply(truth(1, [7]));
    expect([...data.truth.column('frame')]).toEqual([0, 7]);
    expect(data.generation).toBe(1);
  });
});
