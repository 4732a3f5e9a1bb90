import { describe, expect, it } from 'vitest';
import { Store } from '../../src/store/state';
import { Themes } from '../../src/store/themes';

function open(kept: string | null) {
  const storage = {
    text: kept,
    getItem: () => storage.text,
    setItem: (_key: string, text: string) => (storage.text = text),
  };
  const store = new Store();
  const applied: string[] = [];
  const themes = new Themes(store, storage, (theme) => applied.push(theme));
  return { themes, store, storage, applied };
}

describe('the theme', () => {
  it.each([null, '', 'pink'])('is that of the system if %s is kept', (kept) => {
    expect(open(kept).applied).toEqual(['system']);
  });

  it('is kept and shown', () => {
    const { themes, store, storage, applied } = open('dark');
    themes.choose('light');
    expect(applied).toEqual(['dark', 'light']);
    expect(storage.text).toBe('light');
    expect(store.take().has('theme')).toBe(true);
  });

  it('goes through all of them', () => {
    const { themes } = open(null);
    const seen = [themes.current];
    for (let i = 0; i < 3; i += 1) {
      themes.next();
      seen.push(themes.current);
    }
    expect(seen).toEqual(['system', 'light', 'dark', 'system']);
  });
});
