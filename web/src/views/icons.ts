// Icons as inline SVG paths: nothing to download.

import { svg } from './svg';

const kPaths = {
  layout: 'M2 2.5h12v11H2zM3.5 4v8h3V4zM8 4v3.2h4.5V4zM8 8.7V12h4.5V8.7z',
  menu: 'M2.5 3.5h11V5h-11zM2.5 7.2h11v1.6h-11zM2.5 11h11v1.5h-11z',
  chevron: 'M6 3.2 10.8 8 6 12.8 4.9 11.7 8.6 8 4.9 4.3z',
  search:
    'M7 2.5a4.5 4.5 0 0 1 3.6 7.2l3.2 3.2-1 1-3.2-3.2A4.5 4.5 0 1 1 7 2.5zM7 4a3 3 0 1 0 0 6 3 3 0 0 0 0-6z',
  play: 'M5 3.5v9l7.5-4.5z',
  pause: 'M4.5 3.5h2.5v9H4.5zM9 3.5h2.5v9H9z',
  stepBack: 'M11.5 3.5v9L6 8zM4 3.5h1.6v9H4z',
  stepForward: 'M4.5 3.5v9L10 8zM10.4 3.5H12v9h-1.6z',
  toBegin: 'M13 3.5v9L8.5 8zM8.5 3.5v9L4 8zM2.6 3.5H4v9H2.6z',
  toEnd: 'M3 3.5v9L7.5 8zM7.5 3.5v9L12 8zM12 3.5h1.4v9H12z',
  loop: 'M4.5 5H10V3l3.5 2.8L10 8.6V6.5H4.5V8H3V6.5A1.5 1.5 0 0 1 4.5 5zM11.5 11H6v2L2.5 10.2 6 7.4v2.1h5.5V8H13v1.5a1.5 1.5 0 0 1-1.5 1.5z',
  expand: 'M3 3h4v1.5H4.5V7H3zM9 11.5h2.5V9H13v4H9z',
  bin: 'M6 2.5h4v1h3V5H3V3.5h3zM4 6h8l-.6 7.5H4.6z',
  download: 'M7.2 2.5h1.6v5.2l2-2 1.1 1.1L8 10.7 4.1 6.8l1.1-1.1 2 2zM3 12h10v1.5H3z',
  stop: 'M4 4h8v8H4z',
  add: 'M7.2 3.5h1.6v3.7h3.7v1.6H8.8v3.7H7.2V8.8H3.5V7.2h3.7z',
  close:
    'M4.6 3.5 8 6.9l3.4-3.4 1.1 1.1L9.1 8l3.4 3.4-1.1 1.1L8 9.1l-3.4 3.4-1.1-1.1L6.9 8 3.5 4.6z',
  photo:
    'M5.8 3h4.4l1 1.6H14v8.4H2V4.6h2.8zM8 6.1a2.6 2.6 0 1 0 0 5.2 2.6 2.6 0 0 0 0-5.2zm0 1.4a1.2 1.2 0 1 1 0 2.4 1.2 1.2 0 0 1 0-2.4z',
  pencil:
    'M10.9 2.2 13.8 5.1 5.6 13.3 2.3 13.7 2.7 10.4zM10.9 4.3 4.1 11.1 4 12 4.9 11.9 11.7 5.1z',
  repeat: 'M8 3.2a5.2 5.2 0 1 1-5 3.7l1.5.4A3.7 3.7 0 1 0 8 4.7V7.2L4.4 4 8 .8z',
  question:
    'M8 1.8a6.2 6.2 0 1 1 0 12.4A6.2 6.2 0 0 1 8 1.8zm0 1.5a4.7 4.7 0 1 0 0 9.4 4.7 4.7 0 0 0 0-9.4zM7.3 10.2h1.5v1.5H7.3zM8 4.4a2.3 2.3 0 0 1 .9 4.4c-.2.1-.2.2-.2.6H7.3c0-1 .2-1.6 1-1.9A.9.9 0 1 0 7.1 6.7H5.7A2.3 2.3 0 0 1 8 4.4z',
  reverse: 'M11 3.5v9L3.5 8z',
} as const;

export type IconName = keyof typeof kPaths;

export function icon(name: IconName): SVGElement {
  return svg(
    'svg',
    { viewBox: '0 0 16 16', 'aria-hidden': 'true' },
    svg('path', { d: kPaths[name], 'fill-rule': 'evenodd' }),
  );
}
