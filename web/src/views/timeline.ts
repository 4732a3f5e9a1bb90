// Playback controls: buttons, timeline, speed.
import type { Topic } from '../store/state';
import { clockSpan_ns } from '../store/state';
import { formatTime } from '../store/format';
import { kSpeeds } from '../store/playback/player';
import { h, setAttribute, setText } from './dom';
import type { IconName } from './icons';
import { icon } from './icons';
import { frameOf } from './panel';
import { TimelineTrack } from './timeline_track';
import type { Context, View } from './view';

export class Timeline implements View {
  readonly root: HTMLElement;
  private readonly track: TimelineTrack;
  private readonly playIcon = icon('play');
  private readonly pauseIcon = icon('pause');
  private readonly play: HTMLButtonElement;
  private readonly loop: HTMLButtonElement;
  private readonly live: HTMLButtonElement;
  private readonly reverse: HTMLButtonElement;
  private readonly rangeButtons: HTMLButtonElement[];
  private readonly speed = h('select', {
    id: 'speed',
    'aria-label': 'Speed',
    title: 'Speed (+ and −)',
  });
  private readonly time = h('span', { class: 'time', 'data-role': 'time' });
  private readonly end = h('span', { class: 'time-end' });
  private readonly frame = h('span', { class: 'frame', 'data-role': 'frame' });

  constructor(private readonly context: Context) {
    const { player } = context;
    this.track = new TimelineTrack(context);
    this.play = iconButton('play', 'Play or pause (space)', () => player.togglePlay());
    this.play.classList.add('play');
    this.play.replaceChildren(this.playIcon, this.pauseIcon);
    this.loop = iconButton('loop', 'Repeat from the start', () => player.toggleLoop());
    this.reverse = iconButton('reverse', 'Backwards or forwards (R)', () => player.reverse());
    this.rangeButtons = [
      textButton('A', 'Play from here ([)', () => player.setRangeEnd('begin')),
      textButton('B', 'Play to here (])', () => player.setRangeEnd('end')),
      textButton('A–B', 'Play everything again (\\)', () => player.clearRange()),
    ];
    this.live = h(
      'button',
      {
        class: 'live-button',
        title: 'Follow the running flight (L)',
        onclick: () => player.goLive(),
      },
      h('i', {}),
      'Live',
    );
    this.speed.addEventListener('change', () => player.setSpeed(Number(this.speed.value)));
    this.speed.append(...kSpeeds.map((value) => h('option', { value }, `${value}×`)));
    this.root = h(
      'footer',
      { class: 'timeline', 'data-panel': 'timeline', 'aria-label': 'Playback' },
      h(
        'div',
        { class: 'transport' },
        iconButton('toBegin', 'To the start (Home)', () => player.seekEdge('begin')),
        iconButton('stepBack', 'One frame back (←)', () => player.step(-1)),
        this.play,
        iconButton('stepForward', 'One frame forward (→)', () => player.step(1)),
        iconButton('toEnd', 'To the end (End)', () => player.seekEdge('end')),
      ),
      h('div', { class: 'clock' }, h('div', {}, this.time, this.end), this.frame),
      this.track.root,
      h(
        'div',
        { class: 'rates' },
        this.reverse,
        this.speed,
        h('span', { class: 'range-buttons' }, ...this.rangeButtons),
        this.loop,
        this.live,
      ),
    );
  }

  update(changed: ReadonlySet<Topic>): void {
    this.track.update(changed);
    if (!changed.has('playback') && !changed.has('run')) return;
    const { playback } = this.context.store.state;
    const playing = playback?.playing === true;
    this.playIcon.style.display = playing ? 'none' : '';
    this.pauseIcon.style.display = playing ? '' : 'none';
    for (const control of this.root.querySelectorAll<HTMLButtonElement | HTMLSelectElement>(
      'button, select',
    )) {
      control.disabled = playback === null;
    }
    setText(this.time, formatTime(playback?.t_ns ?? 0));
    const [, end_ns] = clockSpan_ns(this.context.store.state);
    setText(this.end, ` / ${formatTime(playback === null ? 0 : end_ns)}`);
    const frame = frameOf(playback);
    setText(this.frame, frame === null ? '' : `frame ${frame}`);
    setAttribute(this.root, 'data-frame', frame === null ? null : String(frame));
    setAttribute(this.root, 'data-t-ns', playback === null ? null : String(playback.t_ns));
    setAttribute(this.root, 'data-playing', playing ? 'true' : 'false');
    setAttribute(this.root, 'data-speed', playback === null ? null : String(playback.speed));
    this.showSpeed(Math.abs(playback?.speed ?? 1));
    setAttribute(this.reverse, 'aria-pressed', (playback?.speed ?? 1) < 0 ? 'true' : 'false');
    const [, , clear] = this.rangeButtons;
    if (clear !== undefined) clear.disabled = (playback?.range ?? null) === null;
    setAttribute(this.loop, 'aria-pressed', playback?.loop === true ? 'true' : 'false');
    setAttribute(this.live, 'aria-pressed', playback?.live === true ? 'true' : 'false');
    this.live.disabled = playback?.flying !== true;
  }

  private showSpeed(speed: number): void {
    if (!kSpeeds.some((value) => value === speed)) {
      this.speed.querySelector('option[data-other]')?.remove();
      this.speed.prepend(h('option', { value: speed, 'data-other': true }, `${speed}×`));
    }
    if (document.activeElement !== this.speed || this.speed.value !== String(speed)) {
      this.speed.value = String(speed);
    }
  }
}

function textButton(text: string, label: string, onclick: () => void): HTMLButtonElement {
  return h(
    'button',
    { class: 'tab range-button', title: label, 'aria-label': label, onclick },
    text,
  );
}

function iconButton(name: IconName, label: string, onclick: () => void): HTMLButtonElement {
  return h(
    'button',
    { class: 'icon-button', title: label, 'aria-label': label, onclick },
    icon(name),
  );
}
