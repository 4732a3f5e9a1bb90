import { beforeEach, describe, expect, it } from 'vitest';
import { TabStorage } from '../../src/store/tab_storage';

const storage = () => {
  const kept = new Map<string, string>();
  return {
    getItem: (key: string) => kept.get(key) ?? null,
    setItem: (key: string, value: string) => void kept.set(key, value),
  };
};

let shared: ReturnType<typeof storage>;
beforeEach(() => {
  shared = storage();
});

describe('TabStorage', () => {
  it('keeps a text for a later tab', () => {
    const first = new TabStorage(storage(), shared);
    expect(first.getItem('a')).toBeNull();
    first.setItem('a', '1');
    first.setItem('a', '2');
    const later = new TabStorage(storage(), shared);
    expect(later.getItem('a')).toBe('2');
    later.setItem('a', '3');
    expect(shared.getItem('a')).toBe('3');
  });

  it('does not overwrite that of another tab, and keeps its own when it is loaded again', () => {
    const own = storage();
    const second = new TabStorage(own, shared);
    second.getItem('a');
    const first = new TabStorage(storage(), shared);
    first.setItem('a', 'first');
    second.setItem('a', 'second');
    expect(shared.getItem('a')).toBe('first');
    const loaded = new TabStorage(own, shared);
    expect(loaded.getItem('a')).toBe('second');
    loaded.setItem('a', 'more');
    expect(shared.getItem('a')).toBe('first');
    first.setItem('a', 'first again');
    expect(shared.getItem('a')).toBe('first again');
  });

  it('goes on with its own when it is loaded again', () => {
    const own = storage();
    new TabStorage(own, shared).setItem('a', '1');
    const loaded = new TabStorage(own, shared);
    expect(loaded.getItem('a')).toBe('1');
    loaded.setItem('a', '2');
    expect(shared.getItem('a')).toBe('2');
  });
});
