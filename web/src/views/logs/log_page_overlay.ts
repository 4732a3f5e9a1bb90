// The page of flight logs, loaded when it is first opened.
import type { Topic } from '../../store/state';
import { kTopics } from '../../store/state';
import { h } from '../dom';
import type { Context, View } from '../view';

export class LogPageOverlay implements View {
  readonly root = h('div', { class: 'overlay log-overlay', hidden: true, 'data-panel': 'logs' });
  private page: View | null = null;
  private loading = false;

  constructor(private readonly context: Context) {}

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('logs')) this.root.hidden = !this.context.store.state.logPage.open;
    if (this.page !== null) this.page.update(changed);
    else if (!this.root.hidden) void this.load();
  }

  private async load(): Promise<void> {
    if (this.loading) return;
    this.loading = true;
    try {
      const { LogPageView } = await import('./log_page');
      this.page = new LogPageView(this.context);
      this.root.append(this.page.root);
      this.page.update(kTopics);
    } catch {
      this.loading = false;
      this.context.store.state.logPage.open = false;
      this.context.store.change('logs');
      this.context.notices.error('The page of flight logs could not be loaded. Reload the page.');
    }
  }
}

/** Files dropped anywhere open the page and are uploaded. */
export function acceptLogFiles(context: Context): void {
  const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') === true;
  document.addEventListener('dragover', (event) => {
    if (hasFiles(event)) event.preventDefault();
  });
  document.addEventListener('drop', (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    const files = [...(event.dataTransfer?.files ?? [])];
    if (files.length === 0) return;
    void context.logs.open().then(() => context.logs.send(files));
  });
}
