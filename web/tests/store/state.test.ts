import { describe, expect, it, vi } from 'vitest';
import { Store } from '../../src/store/state';

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
