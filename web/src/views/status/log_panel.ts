// The run's log by the time of the clock, newest last.
import { formatTime } from '../../store/format';
import type { RunData } from '../../store/run_data';
import type { Topic } from '../../store/state';
import { h } from '../dom';
import type { Panel } from '../panel';
import { makePanel } from '../panel';
import type { Context, View } from '../view';

const kMostLines = 500;
const kNear_px = 24;

export class LogPanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly list = h('ol', { class: 'log' });
  private data: RunData | null = null;
  private generation = 0;
  private offset_ns = 0;
  private shown = 0;
  /** The rows of the run are still on their way. */
  private reading = false;
  /** The newest line is kept in view. */
  private atEnd = true;

  constructor(private readonly context: Context) {
    this.panel = makePanel('log', 'Log');
    this.panel.body.append(this.list);
    this.root = this.panel.root;
    this.list.addEventListener('scroll', () => {
      const left_px = this.list.scrollHeight - this.list.scrollTop - this.list.clientHeight;
      if (this.list.clientHeight > 0) this.atEnd = left_px < kNear_px;
    });
    // A hidden panel loses its place.
    new ResizeObserver(() => this.scroll()).observe(this.list);
  }

  update(changed: ReadonlySet<Topic>): void {
    const read = this.reading && (changed.has('rows') || changed.has('playback'));
    if (!changed.has('log') && !changed.has('run') && !read) return;
    const { data, main, offset_ns } = this.context.store.state;
    const moved = offset_ns !== this.offset_ns;
    if (data !== this.data || data.generation !== this.generation || moved) {
      this.data = data;
      this.generation = data.generation;
      this.offset_ns = offset_ns;
      this.shown = 0;
      this.list.replaceChildren();
    }
    const first = Math.max(this.shown, data.log.length - kMostLines);
    for (const { t_ns, level, text, source } of data.log.slice(first)) {
      const time = h('time', {}, formatTime(t_ns + offset_ns));
      const said = source === '' ? text : `${source}: ${text}`;
      this.list.append(h('li', { 'data-level': level }, time, h('span', {}, said)));
    }
    this.shown = data.log.length;
    while (this.list.children.length > kMostLines) this.list.firstElementChild?.remove();
    this.scroll();
    this.reading = main !== null && data.log.length === 0 && !main.isRead;
    const none = this.reading ? 'Reading the log' : 'Nothing logged.';
    this.panel.showEmpty(data.log.length === 0 ? none : null);
  }

  private scroll(): void {
    if (this.atEnd) this.list.scrollTop = this.list.scrollHeight;
  }
}
