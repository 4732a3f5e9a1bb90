// Loads one thing at a time; while it comes, only the newest of the others waits. On a slow link, where
// things are wanted faster than they come, each one that comes is still shown.

export class NewestLoader<Wanted, Loaded> {
  private next: Wanted | null = null;
  private loading = false;
  /** Increases when nothing is wanted any more: what comes then is dropped. */
  private generation = 0;

  constructor(
    private readonly load: (wanted: Wanted) => Promise<Loaded>,
    private readonly show: (wanted: Wanted, loaded: Loaded) => void,
  ) {}

  want(wanted: Wanted): void {
    this.next = wanted;
    if (!this.loading) void this.run();
  }

  /** Drops what comes and what waits. */
  clear(): void {
    this.next = null;
    this.generation += 1;
  }

  private async run(): Promise<void> {
    this.loading = true;
    while (this.next !== null) {
      const wanted = this.next;
      const { generation } = this;
      this.next = null;
      try {
        const loaded = await this.load(wanted);
        if (this.generation === generation) this.show(wanted, loaded);
      } catch {
        // What cannot be loaded leaves the one before; a newer one may wait.
      }
    }
    this.loading = false;
  }
}
