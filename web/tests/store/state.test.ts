import { describe, expect, it, vi } from 'vitest';
import { clockSpan_ns, kTopics, plannedEnd_ns, Store } from '../../src/store/state';
import { WatchedRun } from '../../src/store/watched_run';
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

  it('shows the palette without waiting for the next frame', () => {
    const store = new Store();
    const listener = vi.fn();
    store.onChange(listener);
    store.change('run');
    store.setPaletteOpen(true);
    expect(listener.mock.calls).toEqual([['next_frame'], ['now']]);
    expect([...store.take()]).toEqual(['run', 'palette']);
    expect(store.state.paletteOpen).toBe(true);
  });

  it('redraws everything for another access, and nothing for the same', () => {
    const store = new Store();
    store.setAccess('operator');
    expect(store.take().size).toBe(0);
    store.setAccess('viewer');
    expect(store.take()).toEqual(kTopics);
  });

  it('notifies a new listener of earlier changes', () => {
    const store = new Store();
    store.change('run');
    const listener = vi.fn();
    store.onChange(listener);
    expect(listener).toHaveBeenCalledTimes(1);
  });
});

describe('the pages', () => {
  it('lie over each other as they were opened', () => {
    const { state } = new Store();
    expect(state.topPage).toBeNull();
    for (const page of [state.logPage, state.sweepPage, state.logPage]) state.openPage(page);
    expect(state.topPage).toBe(state.logPage);
    state.logPage.open = false;
    expect(state.topPage).toBe(state.sweepPage);
    expect(state.frontPage).toBe(state.logPage);
    state.sweepPage.open = false;
    expect(state.topPage).toBeNull();
  });
});

describe('plannedEnd_ns', () => {
  it('is the duration, but not the limit of a live flight', () => {
    const watched = new WatchedRun('r1');
    expect(plannedEnd_ns(watched)).toBe(0);
    watched.run = sampleRun();
    expect(plannedEnd_ns(watched)).toBe(2e9);
    watched.data.apply({ stream: 'vehicle', seq: 0, columns: { t_ns: [0], vehicle: ['1.1'] } });
    expect(plannedEnd_ns(watched)).toBe(0);
  });
});

describe('clockSpan_ns', () => {
  it('holds every watched run where it lies on the clock', () => {
    const { state } = new Store();
    expect(clockSpan_ns(state)).toEqual([0, 1e9]);
    for (const [id, offset_ns] of [
      ['r1', 0],
      ['r2', -3e9],
    ] as const) {
      const watched = new WatchedRun(id);
      watched.run = sampleRun({ id });
      watched.offset_ns = offset_ns;
      state.watched.push(watched);
    }
    expect(clockSpan_ns(state)).toEqual([-3e9, 2e9]);
    const [, second] = state.watched;
    second?.data.apply({ stream: 'truth', seq: 0, columns: { frame: [0], t_ns: [7e9] } });
    expect(clockSpan_ns(state)).toEqual([-3e9, 4e9]);
  });
});
