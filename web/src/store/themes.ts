// The colour theme: dark, light, or that of the system. The browser keeps the choice.
import type { Storage } from './layouts/layouts';
import type { Store } from './state';

export const kThemes = ['system', 'light', 'dark'] as const;
export type Theme = (typeof kThemes)[number];

export const kThemeTitles: Readonly<Record<Theme, string>> = {
  system: 'Theme of the system',
  light: 'Light theme',
  dark: 'Dark theme',
};

const kKey = 'overfly.theme';

export class Themes {
  private chosen: Theme = 'system';

  /** @param apply  shows a theme, before the views redraw themselves */
  constructor(
    private readonly store: Store,
    private readonly storage: Storage,
    private readonly apply: (theme: Theme) => void,
  ) {
    try {
      const kept = storage.getItem(kKey);
      this.chosen = kThemes.find((theme) => theme === kept) ?? 'system';
    } catch {
      // Without storage the system's theme is shown.
    }
    apply(this.chosen);
  }

  get current(): Theme {
    return this.chosen;
  }

  choose(theme: Theme): void {
    this.chosen = theme;
    try {
      this.storage.setItem(kKey, theme);
    } catch {
      // The choice lasts until the page is closed.
    }
    this.refresh();
  }

  /** Chooses the one after the current one. */
  next(): void {
    const at = kThemes.indexOf(this.chosen);
    this.choose(kThemes[(at + 1) % kThemes.length] ?? 'system');
  }

  /** To be called when the system's theme has changed. */
  refresh(): void {
    this.apply(this.chosen);
    this.store.change('theme');
  }
}
