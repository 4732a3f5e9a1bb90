import { describe, expect, it } from 'vitest';
import { RunData } from '../../src/store/run_data';
import { spanAt, stateName, stateSpans, trackStatesAt } from '../../src/store/state_spans';
import { Viewing } from '../support/viewing';

function flown(...states: string[]) {
  const data = new RunData();
  const add = (...more: string[]) => {
    const seq = data.estimates.get('feature')?.states.length ?? 0;
    const t_ns = more.map((_, i) => (seq + i) * 10);
    data.apply({ stream: 'estimate/feature', seq, columns: { t_ns, state: more } });
  };
  add(...states);
  const spans = () => {
    const rows = data.estimates.get('feature');
    if (rows === undefined) throw new Error('no rows');
    return stateSpans(rows, data.generation);
  };
  return { data, add, spans };
}

describe('stateSpans', () => {
  it('joins frames of one state', () => {
    expect(flown('INITIALISING', 'TRACKING', 'TRACKING', 'LOST').spans()).toEqual([
      { state: 'INITIALISING', begin_ns: 0, end_ns: 10 },
      { state: 'TRACKING', begin_ns: 10, end_ns: 30 },
      { state: 'LOST', begin_ns: 30, end_ns: 30 },
    ]);
  });

  it('grows with the flight', () => {
    const { add, spans } = flown('TRACKING');
    expect(spans()).toHaveLength(1);
    add('TRACKING', 'LOST');
    expect(spans()).toEqual([
      { state: 'TRACKING', begin_ns: 0, end_ns: 20 },
      { state: 'LOST', begin_ns: 20, end_ns: 20 },
    ]);
  });

  it('begins again when rows are replaced', () => {
    const { data, spans } = flown('LOST', 'LOST');
    spans();
    const columns = { t_ns: [0, 10], state: ['TRACKING', 'TRACKING'] };
    data.apply({ stream: 'estimate/feature', seq: 0, columns });
    expect(spans()).toEqual([{ state: 'TRACKING', begin_ns: 0, end_ns: 10 }]);
  });
});

describe('spanAt', () => {
  it('finds the state at a time, and none outside the flight', () => {
    const spans = flown('INITIALISING', 'TRACKING', 'LOST', 'LOST').spans();
    expect(spanAt(spans, 15)?.state).toBe('TRACKING');
    expect(spanAt(spans, 30)?.state).toBe('LOST');
    expect(spanAt(spans, -1)).toBeUndefined();
    expect(spanAt(spans, 31)).toBeUndefined();
  });
});

describe('stateName', () => {
  it('is a word, also of an unknown state', () => {
    expect(stateName('LOST')).toBe('lost');
    expect(stateName('SLEEPING')).toBe('sleeping');
  });
});

describe('trackStatesAt', () => {
  it('names every shown estimate with its state, by the clock', () => {
    const viewing = new Viewing();
    viewing.watch();
    viewing.session.setOffset('r1', 5e9);
    viewing.socket.receive({
      type: 'rows',
      run: 'r1',
      stream: 'estimate/feature',
      seq: 0,
      columns: { t_ns: [0, 1e9, 2e9], state: ['TRACKING', 'LOST', 'LOST'] },
    });
    const { state } = viewing.store;
    const [found] = trackStatesAt(state, 6.5e9);
    expect(found).toMatchObject({ state: 'LOST', begin_ns: 6e9, end_ns: 7e9 });
    expect(found?.track.label).toBe('feature');
    expect(trackStatesAt(state, 1e9)).toEqual([]);
    viewing.session.showTrack('r1', 'feature', false);
    expect(trackStatesAt(state, 6.5e9)).toEqual([]);
  });
});
