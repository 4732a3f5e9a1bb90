import { describe, expect, it } from 'vitest';
import { RunData } from '../../src/store/run_data';
import { EstimateCurve, nearestTurn, TruthCurve } from '../../src/store/series';

function flight(yaws: number[]): RunData {
  const data = new RunData();
  const frame = yaws.map((_, k) => k);
  data.apply({
    stream: 'truth',
    seq: 0,
    columns: { frame, t_ns: frame, yaw_deg: yaws, x_m: yaws },
  });
  return data;
}

describe('TruthCurve', () => {
  it('follows an angle across the wrap without a jump, however often rows come', () => {
    const data = flight([170, 179]);
    const curve = new TruthCurve('yaw_deg');
    expect([...curve.update(data)]).toEqual([170, 179]);
    data.apply({
      stream: 'truth',
      seq: 2,
      columns: { frame: [2, 3, 4], t_ns: [2, 3, 4], yaw_deg: [-179, -170, 175] },
    });
    expect([...curve.update(data)]).toEqual([170, 179, 181, 190, 175]);
  });

  it('leaves positions as they are', () => {
    expect([...new TruthCurve('x_m').update(flight([170, -170]))]).toEqual([170, -170]);
  });
});

describe('EstimateCurve', () => {
  const estimate = (frame: number[], yaw_deg: (number | null)[]) => ({
    stream: 'estimate/a',
    seq: 0,
    columns: { frame, t_ns: frame, state: frame.map(() => 'TRACKING'), yaw_deg },
  });

  it('lies on the turn of the truth and breaks where there is no pose', () => {
    const data = flight([179, -179, -178, -177]);
    data.apply(estimate([0, 1, 3], [-179, null, -175]));
    const truth = new TruthCurve('yaw_deg').update(data);
    const rows = data.estimates.get('a');
    if (rows === undefined) throw new Error('no rows');
    expect(new EstimateCurve('yaw_deg').update(data, rows, truth)).toEqual([181, null, null, 185]);
  });

  it('waits for truth rows that come later', () => {
    const data = flight([0]);
    data.apply(estimate([0, 1], [1, 2]));
    const truth = new TruthCurve('yaw_deg');
    const curve = new EstimateCurve('yaw_deg');
    const rows = data.estimates.get('a');
    if (rows === undefined) throw new Error('no rows');
    expect(curve.update(data, rows, truth.update(data))).toEqual([1]);
    data.apply({ stream: 'truth', seq: 1, columns: { frame: [1], t_ns: [1], yaw_deg: [0] } });
    expect(curve.update(data, rows, truth.update(data))).toEqual([1, 2]);
  });
});

describe('nearestTurn', () => {
  it.each([
    [-179, 179, 181],
    [10, 730, 730],
    [0, -350, -360],
  ])('brings %d near %d', (angle, reference, expected) => {
    expect(nearestTurn(angle, reference)).toBe(expected);
  });
});
