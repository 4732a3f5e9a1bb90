// What cannot be undone is asked twice: the second click within some seconds is the answer.

const kAsked_ms = 3000;

export class Confirmation {
  private asked = false;

  /** @param show  called with whether the question is open */
  constructor(
    private readonly show: (asked: boolean) => void,
    private readonly later: (callback: () => void, delay_ms: number) => void,
  ) {}

  /** @return whether this click confirms the one before */
  click(): boolean {
    const confirmed = this.asked;
    this.set(!confirmed);
    if (!confirmed) this.later(() => this.set(false), kAsked_ms);
    return confirmed;
  }

  private set(asked: boolean): void {
    if (this.asked === asked) return;
    this.asked = asked;
    this.show(asked);
  }
}
