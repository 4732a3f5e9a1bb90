// The logs of the server, and the upload of another one.
import type { LogEntry } from '../../protocol/log_types';
import { wordsFor } from '../access';
import { deleteButton } from '../delete_button';
import { h, rebuild, setText } from '../dom';
import type { Context } from '../view';

export function sizeText(bytes: number): string {
  if (bytes >= 1e9) return `${(bytes / 1e9).toFixed(2)} GB`;
  return bytes >= 1e6 ? `${(bytes / 1e6).toFixed(1)} MB` : `${Math.ceil(bytes / 1e3)} kB`;
}

export class LogListView {
  readonly root: HTMLElement;
  private readonly rows = h('ul', { class: 'log-rows', 'data-role': 'log-rows' });
  private readonly error = h('div', { class: 'form-errors', role: 'alert' });
  private readonly bar = h('div', { class: 'upload-bar' });
  private readonly uploadText = h('span', {});
  private readonly uploading: HTMLElement;
  private readonly place = h('div', { class: 'upload-place' });
  private readonly picker = h('input', {
    type: 'file',
    multiple: true,
    hidden: true,
    'data-role': 'log-file',
  });
  private readonly button: HTMLButtonElement;

  constructor(private readonly context: Context) {
    this.button = h(
      'button',
      {
        class: 'secondary',
        type: 'button',
        title: 'Logs, or a mapping (.json) together with its CSV files',
        onclick: () => this.picker.click(),
      },
      'Upload ...',
    );
    this.picker.addEventListener('change', () => {
      const files = [...(this.picker.files ?? [])];
      this.picker.value = '';
      void this.context.logs.send(files);
    });
    this.uploading = h(
      'div',
      { class: 'uploading', hidden: true },
      this.uploadText,
      h('div', { class: 'upload-track' }, this.bar),
      h(
        'button',
        { class: 'secondary', onclick: () => this.context.logs.cancelUpload() },
        'Cancel',
      ),
    );
    this.root = h(
      'section',
      { class: 'log-list' },
      this.rows,
      this.error,
      this.uploading,
      h(
        'div',
        { class: 'upload-line', 'data-changes': true },
        this.button,
        this.place,
        this.picker,
      ),
    );
  }

  update(): void {
    const page = this.context.store.state.logPage;
    const { list, chosen, upload } = page;
    rebuild(this.rows, JSON.stringify([list?.logs, chosen]), () => {
      if (list === null) return [h('li', { class: 'muted' }, 'Reading the logs')];
      if (list.logs.length === 0) {
        const none = wordsFor('No flight logs yet: upload one.', 'No flight logs yet.');
        return [h('li', { class: 'muted' }, ...none)];
      }
      return list.logs.map((entry) => this.row(entry, entry.name === chosen));
    });
    const errors = [page.listError, page.uploadError];
    if (list?.complete === false) errors.push('The data folders hold too many files to list all.');
    setText(this.error, errors.filter((text) => text !== null).join('\n'));
    this.error.hidden = this.error.textContent === '';
    this.uploading.hidden = upload === null;
    setText(
      this.uploadText,
      upload === null ? '' : `${upload.name}: ${Math.floor(upload.share * 100)} %`,
    );
    this.bar.style.width = `${(upload?.share ?? 0) * 100}%`;
    const quota = list?.uploads.quota_bytes ?? 0;
    this.button.disabled = upload !== null || quota === 0;
    const used = `${sizeText(list?.uploads.used_bytes ?? 0)} of ${sizeText(quota)} used`;
    const none = 'This server takes no uploads.';
    setText(this.place, list === null ? '' : quota === 0 ? none : `or drop files here · ${used}`);
  }

  private row(entry: LogEntry, chosen: boolean): HTMLElement {
    const parts = entry.name.split('/');
    const row = h(
      'li',
      { class: 'log-row', 'data-log': entry.name, 'aria-current': chosen ? 'true' : 'false' },
      h(
        'button',
        {
          class: 'log-choice',
          title: entry.file,
          onclick: () => void this.context.logs.choose(entry.name),
        },
        h('b', {}, parts.at(-1) ?? entry.name),
        h(
          'span',
          { class: 'muted' },
          `${parts.slice(0, -1).join('/')} · ${entry.format} · ${sizeText(entry.size_bytes)}`,
        ),
      ),
    );
    if (entry.uploaded) {
      row.append(
        deleteButton(entry.name, 'this upload', () => void this.context.logs.remove(entry.name)),
      );
    }
    return row;
  }
}
