// Keeps a text for each tab and for the time after it: tabs do not overwrite each other's.
import type { Storage } from './layouts/layouts';

export class TabStorage implements Storage {
  /** What this tab has last read from the shared storage, or written to it. */
  private readonly known = new Map<string, string | null>();

  /**
   * @param tab  is empty in a new tab, and stays when the page is loaded again
   * @param shared  by all tabs, also later ones
   */
  constructor(
    private readonly tab: Storage,
    private readonly shared: Storage,
  ) {}

  getItem(key: string): string | null {
    const own = this.tab.getItem(key);
    const shared = this.shared.getItem(key);
    if (own === null || own === shared) this.known.set(key, shared);
    return own ?? shared;
  }

  setItem(key: string, value: string): void {
    this.tab.setItem(key, value);
    const shared = this.shared.getItem(key);
    // Another tab keeps its own there.
    if (shared !== null && shared !== this.known.get(key)) return;
    this.shared.setItem(key, value);
    this.known.set(key, value);
  }
}
