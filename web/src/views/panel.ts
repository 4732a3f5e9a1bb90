// The frame of every panel: title, tools, and the number of the frame that it shows.
import type { RateBadge } from '../store/pictures/picture_rates';
import type { RunPlayback } from '../store/playback/run_playback';
import { h, setAttribute, setText } from './dom';
import { scrollRow } from './scroll_row';

export interface Panel {
  root: HTMLElement;
  tools: HTMLElement;
  body: HTMLElement;
  /** @param expected  frame of the playback cursor; if it differs, the difference is shown */
  showFrame(frame: number | null, expected?: number | null): void;
  /** The rate of its pictures while they move. */
  showRate(badge: RateBadge): void;
  /** Text shown if there is no content; null = there is content. */
  showEmpty(text: string | null): void;
}

/** Frame at the cursor; null before the first one. */
export function frameOf(playback: RunPlayback | null): number | null {
  return playback === null || playback.frame < 0 ? null : playback.frame;
}

export function makePanel(name: string, title: string): Panel {
  const badge = h('span', { class: 'frame-badge', title: 'Frame shown' });
  const rate = h('span', { class: 'rate-badge', 'data-role': 'rate' });
  const tools = h('div', { class: 'panel-tools' });
  const empty = h('div', { class: 'panel-empty', hidden: true });
  // Over the picture: in the header it would come and go among the tools.
  const body = h('div', { class: 'panel-body' }, empty, rate);
  const root = h('section', { class: 'panel', 'data-panel': name, 'aria-label': title });
  const header = h(
    'header',
    { class: 'panel-header' },
    h('h2', {}, title),
    scrollRow(tools),
    badge,
  );
  root.append(header, body);
  return {
    root,
    tools,
    body,
    showFrame(frame, expected = null) {
      const off = frame === null || expected === null ? 0 : frame - expected;
      const offText = off === 0 ? '' : ` (${off > 0 ? '+' : '−'}${Math.abs(off)})`;
      setText(badge, frame === null ? '' : `#${frame}${offText}`);
      setAttribute(root, 'data-frame', frame === null ? null : String(frame));
    },
    showRate({ text, hint, reduced }) {
      setText(rate, text);
      setAttribute(rate, 'title', hint === '' ? null : hint);
      rate.classList.toggle('reduced', reduced);
    },
    showEmpty(text) {
      empty.hidden = text === null;
      setText(empty, text ?? '');
    },
  };
}
