// A sheet that is opened and closed by its opener, and closed by Escape and by a press elsewhere. Style
// sheets show it by the `aria-expanded` of the opener before it.
import { h, setAttribute } from './dom';

export class Menu {
  readonly root: HTMLElement;

  /** @param onOpened  called before the sheet is seen */
  constructor(
    private readonly opener: HTMLElement,
    sheet: HTMLElement,
    private readonly onOpened: () => void = () => undefined,
  ) {
    setAttribute(opener, 'aria-controls', sheet.id);
    this.root = h('div', { class: 'menu' }, opener, sheet);
    this.close();
    opener.addEventListener('click', () => this.open(!this.isOpen));
    document.addEventListener('pointerdown', ({ target }) => {
      if (target instanceof Node && !this.root.contains(target)) this.close();
    });
    document.addEventListener('keydown', ({ key }) => {
      if (key !== 'Escape' || !this.isOpen) return;
      this.close();
      opener.focus();
    });
  }

  get isOpen(): boolean {
    return this.opener.getAttribute('aria-expanded') === 'true';
  }

  close(): void {
    this.open(false);
  }

  private open(open: boolean): void {
    setAttribute(this.opener, 'aria-expanded', String(open));
    if (open) this.onOpened();
  }
}
