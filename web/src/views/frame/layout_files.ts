// Own layouts as files: buttons of the menu of layouts.
import { download } from '../download';
import { h } from '../dom';
import { icon } from '../icons';
import type { Context } from '../view';

export class LayoutFiles {
  readonly root: HTMLElement;
  private readonly exporter: HTMLButtonElement;
  private readonly file = h('input', {
    type: 'file',
    hidden: true,
    accept: '.json',
    'aria-label': 'File with layouts',
    'data-role': 'layout-file',
  });

  constructor(private readonly context: Context) {
    this.exporter = h(
      'button',
      {
        class: 'secondary',
        type: 'button',
        title: 'Save all own layouts as a file',
        'data-role': 'export-layouts',
        onclick: () => save(context, context.layouts.ownNames),
      },
      'Export all',
    );
    this.file.addEventListener('change', () => {
      const [file] = this.file.files ?? [];
      if (file !== undefined) void context.layoutExchange.import(file);
      this.file.value = '';
    });
    const importer = h(
      'button',
      {
        class: 'secondary',
        type: 'button',
        title: 'Add the layouts of a file; it can also be dropped on the page',
        'data-role': 'import-layouts',
        onclick: () => this.file.click(),
      },
      'Import',
    );
    this.root = h(
      'div',
      {},
      h('h2', {}, 'Own layouts as files'),
      h('div', { class: 'menu-files' }, importer, this.file, this.exporter),
    );
  }

  update(): void {
    this.exporter.disabled = this.context.layouts.ownNames.length === 0;
  }
}

/** Saves one own layout as a file. */
export function exportButton(context: Context, name: string): HTMLElement {
  return h(
    'button',
    {
      class: 'icon-button',
      type: 'button',
      title: `Save the layout ${name} as a file`,
      'aria-label': `Export the layout ${name}`,
      onclick: () => save(context, [name]),
    },
    icon('download'),
  );
}

function save(context: Context, names: readonly string[]): void {
  const { name, text } = context.layoutExchange.export(names);
  download(name, new Blob([text], { type: 'application/json' }));
}
