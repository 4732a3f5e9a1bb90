// What can be undone and redone.

const kMost = 200;

export class History<T> {
  private before: T[] = [];
  private after: T[] = [];
  /** What the last step was; the next one of the same kind continues it. */
  private kind: string | null = null;

  /**
   * Records a value that is about to be replaced.
   * @param kind  edits of one kind in a row are one step, such as the letters of a word; null = none
   */
  record(value: T, kind: string | null = null): void {
    if (kind === null || kind !== this.kind) this.before = [...this.before, value].slice(-kMost);
    this.kind = kind;
    this.after = [];
  }

  /** @return the value before `present`; null if there is none */
  undo(present: T): T | null {
    const value = this.before.pop();
    if (value === undefined) return null;
    this.after.push(present);
    this.kind = null;
    return value;
  }

  redo(present: T): T | null {
    const value = this.after.pop();
    if (value === undefined) return null;
    this.before.push(present);
    this.kind = null;
    return value;
  }

  get canUndo(): boolean {
    return this.before.length > 0;
  }
  get canRedo(): boolean {
    return this.after.length > 0;
  }

  clear(): void {
    this.before = [];
    this.after = [];
    this.kind = null;
  }
}
