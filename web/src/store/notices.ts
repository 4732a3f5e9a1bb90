// Short messages to the viewer that disappear by themselves.
import type { Store } from './state';

const kShown_ms = 8000;
const kMost = 4;

export class Notices {
  private next = 1;

  constructor(
    private readonly store: Store,
    private readonly later: (callback: () => void, delay_ms: number) => void,
  ) {}

  error(text: string): void {
    this.add('error', text);
  }

  info(text: string): void {
    this.add('info', text);
  }

  dismiss(id: number): void {
    const { state } = this.store;
    state.notices = state.notices.filter((notice) => notice.id !== id);
    this.store.change('notices');
  }

  private add(level: 'info' | 'error', text: string): void {
    const { state } = this.store;
    const same = state.notices.filter((notice) => notice.text !== text);
    const id = this.next;
    this.next += 1;
    state.notices = [...same, { id, level, text }].slice(-kMost);
    this.store.change('notices');
    this.later(() => this.dismiss(id), kShown_ms);
  }
}
