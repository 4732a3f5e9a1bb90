import { describe, expect, it, vi } from 'vitest';
import type { Differences } from '../../../src/protocol/rest_types';
import { DifferenceReader } from '../../../src/store/runs/difference_reader';

function reading() {
  const calls: {
    runs: readonly string[];
    signal: AbortSignal;
    answer: (d: Differences) => void;
  }[] = [];
  const differences = (runs: readonly string[], signal: AbortSignal) =>
    new Promise<Differences>((answer) => calls.push({ runs, signal, answer }));
  const onChange = vi.fn();
  return { calls, onChange, reader: new DifferenceReader({ differences }, onChange) };
}

const found = (runs: string[]): Differences => ({ runs, fields: [], left_out: 0 });

describe('DifferenceReader', () => {
  it('reads once for the same runs, and again when the key changes', async () => {
    const { calls, reader } = reading();
    reader.show(['a', 'b'], 'completed running');
    reader.show(['a', 'b'], 'completed running');
    expect(calls).toHaveLength(1);
    calls[0]?.answer(found(['a', 'b']));
    await vi.waitFor(() => expect(reader.answer).toEqual(found(['a', 'b'])));
    reader.show(['a', 'b'], 'completed completed');
    expect(calls).toHaveLength(2);
    expect(reader.answer).toBeNull();
  });

  it('drops the answer for runs that are no longer shown', async () => {
    const { calls, onChange, reader } = reading();
    reader.show(['a', 'b'], '');
    reader.show(['a', 'c'], '');
    expect(calls[0]?.signal.aborted).toBe(true);
    calls[0]?.answer(found(['a', 'b']));
    calls[1]?.answer(found(['a', 'c']));
    await vi.waitFor(() => expect(reader.answer).toEqual(found(['a', 'c'])));
    expect(onChange).toHaveBeenCalledTimes(1);
  });

  it('asks for nothing with fewer than two runs', () => {
    const { calls, reader } = reading();
    reader.show(['a'], '');
    expect(calls).toHaveLength(0);
    expect(reader.answer).toBeNull();
  });

  it('gives the reason why it could not be read, and reads again', async () => {
    const refused = new Error('run "b": no such run');
    const rest = { differences: (): Promise<Differences> => Promise.reject(refused) };
    const reader = new DifferenceReader(rest, () => {});
    reader.show(['a', 'b'], '');
    await vi.waitFor(() => expect(reader.answer).toBe('run "b": no such run'));
    rest.differences = () => Promise.resolve(found(['a', 'b']));
    reader.show(['a', 'b'], '');
    expect(reader.answer).toBe('run "b": no such run');
    await vi.waitFor(() => expect(reader.answer).toEqual(found(['a', 'b'])));
  });
});
