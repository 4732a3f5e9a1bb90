// Keeps an address and the screen the same: one that is new is opened, and what changes on the screen is
// written into the one that was opened. An address that is not opened yet is never overwritten.

/** The address bar, so that tests need no browser. */
export interface AddressBar {
  /** "#..." or ''. */
  read(): string;
  /** In place of the one that is read. */
  replace(hash: string): void;
}

export interface AddressedScreen {
  open(hash: string): void;
  /** The address of what is shown; null while that is not yet what was opened. */
  shown(): string | null;
}

export class Address {
  /** The last one that was opened or written. */
  private known = '';
  private opening = false;

  constructor(
    private readonly bar: AddressBar,
    private readonly screen: AddressedScreen,
  ) {}

  /**
   * To be called when either may have changed. The browser's event for a new address comes later
   * than the address can be read, so the event does not decide what is new.
   */
  update(): void {
    // Opening changes one part of the screen after the other.
    if (this.opening) return;
    const hash = this.bar.read();
    if (hash !== this.known) {
      this.known = hash;
      this.opening = true;
      try {
        this.screen.open(hash);
      } finally {
        this.opening = false;
      }
      return;
    }
    const shown = this.screen.shown();
    if (shown === null || shown === hash) return;
    this.bar.replace(shown);
    this.known = this.bar.read();
  }
}
