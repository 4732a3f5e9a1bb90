// A list whose entries are kept as long as they show the same: a change of one of a thousand makes
// one element. A control keeps the focus if its entry is made again or moved.
import type { Focused } from './focus';
import { focusAgain, focusIn } from './focus';

export interface KeyedEntry {
  id: string;
  /** Differs if the entry must be made again. */
  key: string;
  make: () => HTMLElement;
  /** Sets, in a new or kept element, what changes without another key: its controls keep the focus. */
  refresh?: (element: HTMLElement) => void;
}

export class KeyedList {
  private readonly made = new Map<string, { key: string; element: HTMLElement }>();

  constructor(private readonly root: HTMLElement) {}

  show(entries: readonly KeyedEntry[]): void {
    const focused = this.focused();
    this.place(entries);
    const entry = focused === null ? undefined : this.made.get(focused.id);
    if (focused !== null && entry !== undefined) focusAgain(entry.element, focused.control);
  }

  /** The entry and its control that has the focus. */
  private focused(): { id: string; control: Focused } | null {
    if (!this.root.contains(document.activeElement)) return null;
    for (const [id, { element }] of this.made) {
      const control = focusIn(element);
      if (control !== null) return { id, control };
    }
    return null;
  }

  private place(entries: readonly KeyedEntry[]): void {
    const wanted = new Set(entries.map(({ id }) => id));
    for (const [id, { element }] of this.made) {
      if (wanted.has(id)) continue;
      element.remove();
      this.made.delete(id);
    }
    let place = this.root.firstElementChild;
    for (const { id, key, make, refresh } of entries) {
      const before = this.made.get(id);
      let element = before?.element;
      if (element === undefined || before?.key !== key) {
        const next = make();
        if (element !== undefined) {
          if (place === element) place = next;
          element.replaceWith(next);
        }
        element = next;
        this.made.set(id, { key, element });
      }
      refresh?.(element);
      if (place === element) place = place.nextElementSibling;
      else this.root.insertBefore(element, place);
    }
  }
}
