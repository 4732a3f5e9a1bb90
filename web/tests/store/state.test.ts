import { describe, expect, it, vi } from 'vitest';
import { plannedEnd_ns, Store } from '../../src/store/state';
import { sampleRun } from '../support/samples';

describe('Store', () => {
  it('calls back once until the topics are taken', () => {
    const store = new Store();
    const listener = vi.fn();
    store.onChange(listener);
    store.change('run', 'rows');
    store.change('run');
    expect(listener).toHaveBeenCalledTimes(1);
    expect([...store.take()]).toEqual(['run', 'rows']);
    store.change('log');
    expect(listener).toHaveBeenCalledTimes(2);
  });

  it('notifies a new listener of earlier changes', () => {
    const store = new Store();
    store.change('run');
    const listener = vi.fn();
    store.onChange(listener);
    expect(listener).toHaveBeenCalledTimes(1);
  });
});

describe('plannedEnd_ns', () => {
  it('is the duration, but not the limit of a live flight', () => {
    const { state } = new Store();
    expect(plannedEnd_ns(state)).toBe(0);
    state.run = sampleRun();
    expect(plannedEnd_ns(state)).toBe(2e9);
    state.data.apply({ stream: 'vehicle', seq: 0, columns: { t_ns: [0], vehicle: ['1.1'] } });
    expect(plannedEnd_ns(state)).toBe(0);
  });
});
