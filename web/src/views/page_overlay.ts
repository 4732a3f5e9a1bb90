// A page over the dashboard, loaded when it is first opened. It gets the keyboard while it is open.
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
  /** What had the focus when the page was opened. */
  private before: Element | null = null;

  /** @param behind  what cannot be reached while a page covers it */
  constructor(
    private readonly context: Context,
    private readonly options: PageOptions,
    private readonly behind: readonly HTMLElement[],
  ) {
    this.root = h('div', {
      class: 'overlay log-overlay',
      hidden: true,
      tabindex: -1,
      'data-panel': options.name,
    });
  }

  update(changed: ReadonlySet<Topic>): void {
    const { topic, page } = this.options;
    const { state } = this.context.store;
    const shown = page(state);
    const { open } = shown;
    const rises = this.root.hidden || (state.frontPage === shown && this.isBehind());
    const opens = changed.has(topic) && open && rises;
    if (opens) this.uncover();
    if (changed.has(topic) && !open && !this.root.hidden) this.leave();
    if (this.page !== null) this.page.update(changed);
    else if (!this.root.hidden) void this.load();
    if (opens) this.takeFocus();
  }

  private uncover(): void {
    this.before = document.activeElement;
    this.root.hidden = false;
    // Over the pages that are open already.
    if (this.isBehind()) this.frontmost()?.after(this.root);
    this.disableBehind();
  }

  /** The page that is on top if it is open: the last one of the document. */
  private frontmost(): Element | undefined {
    const pages = this.root.parentElement?.querySelectorAll(':scope > .log-overlay') ?? [];
    return pages[pages.length - 1];
  }

  private isBehind(): boolean {
    return this.frontmost() !== this.root;
  }

  private leave(): void {
    const { activeElement } = document;
    const had = activeElement === document.body || this.root.contains(activeElement);
    this.root.hidden = true;
    this.disableBehind();
    if (had && this.before instanceof HTMLElement) this.before.focus();
  }

  private disableBehind(): void {
    for (const part of this.behind) part.inert = this.context.store.state.covered;
  }

  /** A page may have given it to a part of itself. */
  private takeFocus(): void {
    const page = this.page?.root ?? this.root;
    if (!page.contains(document.activeElement)) page.focus({ preventScroll: true });
  }

  private async load(): Promise<void> {
    if (this.loading) return;
    this.loading = true;
    const { context, options } = this;
    try {
      this.page = await options.load(context);
      this.page.root.tabIndex = -1;
      this.root.append(this.page.root);
      const waits = document.activeElement === this.root;
      this.page.update(kTopics);
      if (waits) this.takeFocus();
    } catch {
      this.loading = false;
      options.page(context.store.state).open = false;
      context.store.change(options.topic);
      context.notices.error('The page could not be loaded. Reload the dashboard.');
    }
  }
}
