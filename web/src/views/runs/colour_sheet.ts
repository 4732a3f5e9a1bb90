// Gives a track another colour: one of the palette, which suits every theme and sight, or any.
import { kPaletteNames } from '../../store/track_colours';
import type { Track } from '../../store/tracks';
import { estimateColour, trackColour } from '../colours';
import { h } from '../dom';
import { paint } from '../paint';
import { rgbOf } from '../plot3d/rgb';
import type { Context } from '../view';

export class ColourSheet {
  readonly root = h('div', { class: 'colour-sheet', popover: 'auto', role: 'group' });

  constructor(private readonly context: Context) {}

  /** @param opener  the button that opens it */
  open(track: Track, opener: HTMLElement): void {
    const { run, name, label, chosen } = track;
    const choose = (colour: string | null) => {
      this.root.hidePopover();
      this.context.colours.choose(run.id, name, colour);
    };
    const other = h('input', {
      type: 'color',
      value: hexOf(trackColour(track)),
      'aria-label': `Any colour for ${label}`,
    });
    other.addEventListener('change', () => choose(other.value.slice(1)));
    this.root.setAttribute('aria-label', `Colour of ${label}`);
    this.root.replaceChildren(
      ...kPaletteNames.map((title, i) =>
        h('button', {
          class: 'colour-choice',
          style: `background:${estimateColour(i)}`,
          title,
          'aria-label': `${title} for ${label}`,
          'aria-pressed': chosen === String(i + 1) ? 'true' : 'false',
          onclick: () => choose(String(i + 1)),
        }),
      ),
      h('label', { title: 'Any colour' }, other),
      h(
        'button',
        { class: 'tab', title: 'The default colour', onclick: () => choose(null) },
        'Automatic',
      ),
    );
    this.root.showPopover();
    const { left, bottom } = opener.getBoundingClientRect();
    this.root.style.left = `${Math.min(left, window.innerWidth - this.root.offsetWidth - 8)}px`;
    this.root.style.top = `${Math.min(bottom + 4, window.innerHeight - this.root.offsetHeight - 8)}px`;
    this.root.querySelector('button')?.focus();
  }
}

function hexOf(colour: string): string {
  const parts = rgbOf(paint(colour)).map((part) => Math.round(part * 255));
  return `#${parts.map((part) => part.toString(16).padStart(2, '0')).join('')}`;
}
