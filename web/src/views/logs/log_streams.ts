// What a log contains: streams with rates, gaps and jumps, and warnings.
import type { LogInfo, LogStream } from '../../protocol/log_types';
import { h, rebuild } from '../dom';
import { sizeText } from './log_list';

export class LogStreams {
  readonly root = h('div', { class: 'log-streams' });
  private shown: LogInfo | null = null;

  show(info: LogInfo | null): void {
    if (info === this.shown) return;
    this.shown = info;
    rebuild(this.root, String(Math.random()), () => (info === null ? [] : this.content(info)));
  }

  private content(info: LogInfo): HTMLElement[] {
    const sources = info.streams.filter(({ origin }) => origin !== undefined);
    const others = info.streams.filter(({ origin }) => origin === undefined);
    const title = `${info.format}, ${sizeText(info.size_bytes)}, ${info.streams.length} streams`;
    const parts: HTMLElement[] = [h('div', { class: 'log-title' }, title)];
    if (info.truth !== null) {
      const { position, attitude, reason } = info.truth;
      const angles = attitude === null || attitude === position ? '' : ` with ${attitude}`;
      parts.push(
        h(
          'div',
          { class: 'log-truth' },
          'Recommended: ',
          h('b', {}, position + angles),
          `, ${reason}`,
        ),
      );
    }
    parts.push(
      h(
        'table',
        { class: 'log-table', 'data-role': 'log-streams' },
        h(
          'thead',
          {},
          h(
            'tr',
            {},
            ...['Stream', 'Hz', 'Messages', 'Gaps', 'Jumps'].map((text) => h('th', {}, text)),
          ),
        ),
        h('tbody', {}, ...[...sources, ...others].map(streamRow)),
      ),
    );
    if (info.warnings.length > 0) {
      parts.push(
        h('ul', { class: 'log-warnings' }, ...info.warnings.map((text) => h('li', {}, text))),
      );
    }
    return parts;
  }
}

function streamRow(stream: LogStream): HTMLElement {
  const { name, rate_hz, messages, gaps, longest_gap_s, jumps = 0, largest_jump_m = 0 } = stream;
  const what = [
    (stream.positions ?? 0) > 0 ? 'positions' : '',
    (stream.attitudes ?? 0) > 0 ? 'attitudes' : '',
    stream.origin ?? '',
  ].filter((text) => text !== '');
  return h(
    'tr',
    { 'data-stream': name, class: stream.origin === undefined ? 'other' : '' },
    h('td', { title: [name, ...what].join(', ') }, name),
    h('td', {}, rate_hz > 0 ? rate_hz.toFixed(1) : '–'),
    h('td', {}, String(messages)),
    h('td', { title: gaps > 0 ? `longest ${longest_gap_s.toFixed(1)} s` : '' }, dashed(gaps)),
    h('td', { title: jumps > 0 ? `largest ${largest_jump_m.toFixed(0)} m` : '' }, dashed(jumps)),
  );
}

function dashed(count: number): string {
  return count > 0 ? String(count) : '–';
}
