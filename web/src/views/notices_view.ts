// Messages shown for a while over a corner of the screen.
import type { Topic } from '../store/state';
import { h, rebuild } from './dom';
import type { Context, View } from './view';

export class NoticesView implements View {
  readonly root = h('div', { class: 'notices', role: 'status', 'aria-live': 'polite' });

  constructor(private readonly context: Context) {}

  update(changed: ReadonlySet<Topic>): void {
    if (!changed.has('notices')) return;
    const { notices } = this.context.store.state;
    rebuild(this.root, notices.map(({ id }) => id).join(' '), () =>
      notices.map(({ id, level, text }) =>
        h(
          'button',
          {
            class: 'notice',
            'data-of': id,
            'data-level': level,
            title: 'Dismiss',
            onclick: () => this.context.notices.dismiss(id),
          },
          text,
        ),
      ),
    );
  }
}
