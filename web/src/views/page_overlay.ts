// A page over the dashboard, loaded when it is first opened.
import type { State, Topic } from '../store/state';
import { kTopics } from '../store/state';
import { h } from './dom';
import type { Context, View } from './view';

export interface PageOptions {
  /** Names the page in the document. */
  name: string;
  topic: Topic;
  page: (state: State) => { open: boolean };
  load: (context: Context) => Promise<View>;
}

export class PageOverlay implements View {
  readonly root: HTMLElement;
  private page: View | null = null;
  private loading = false;

  constructor(
    private readonly context: Context,
    private readonly options: PageOptions,
  ) {
    this.root = h('div', {
      class: 'overlay log-overlay',
      hidden: true,
      'data-panel': options.name,
    });
  }

  update(changed: ReadonlySet<Topic>): void {
    const { topic, page } = this.options;
    if (changed.has(topic)) this.root.hidden = !page(this.context.store.state).open;
    if (this.page !== null) this.page.update(changed);
    else if (!this.root.hidden) void this.load();
  }

  private async load(): Promise<void> {
    if (this.loading) return;
    this.loading = true;
    const { context, options } = this;
    try {
      this.page = await options.load(context);
      this.root.append(this.page.root);
      this.page.update(kTopics);
    } catch {
      this.loading = false;
      options.page(context.store.state).open = false;
      context.store.change(options.topic);
      context.notices.error('The page could not be loaded. Reload the dashboard.');
    }
  }
}
