// A row that scrolls sideways, with an arrow at an edge beyond which there is more.
import { hiddenEnds } from '../store/hidden_ends';
import { h, perFrame } from './dom';
import { icon } from './icons';

/** Of the row's width, so that something stays in sight. */
const kStep = 0.7;
const kLeastStep_px = 60;

/** @return the row with its arrows, in its place */
export function scrollRow(row: HTMLElement): HTMLElement {
  const left = arrow(row, 'left');
  const right = arrow(row, 'right');
  const show = perFrame(() => {
    const hidden = hiddenEnds(row);
    left.hidden = !hidden.left;
    right.hidden = !hidden.right;
  });
  row.addEventListener('scroll', show, { passive: true });
  new ResizeObserver(show).observe(row);
  new MutationObserver(show).observe(row, {
    attributes: true,
    characterData: true,
    childList: true,
    subtree: true,
  });
  return h('div', { class: 'scroll-row' }, row, left, right);
}

/** For pointers: the keyboard reaches what is in the row, and what has the focus is in sight. */
function arrow(row: HTMLElement, side: 'left' | 'right'): HTMLElement {
  const sign = side === 'left' ? -1 : 1;
  return h(
    'button',
    {
      class: `row-arrow ${side}`,
      type: 'button',
      tabindex: -1,
      hidden: true,
      title: 'There is more',
      'aria-label': `Scroll to the ${side}`,
      onclick: () => {
        const step_px = Math.max(kStep * row.clientWidth, kLeastStep_px);
        row.scrollBy({ left: sign * step_px, behavior: 'smooth' });
      },
    },
    icon('chevron'),
  );
}
