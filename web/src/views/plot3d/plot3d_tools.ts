// The tools of the 3D plot: directions of view, exaggeration of heights, and error lines.
import { h, setAttribute } from '../dom';
import type { Direction } from './plot3d_view';

const kHeightScales = [1, 2, 5, 10, 20] as const;

export interface Plot3dActions {
  /** Shows everything; null = from the present direction. */
  fit: (direction: Direction | null) => void;
  exaggerate: (heightScale: number) => void;
  showErrors: (on: boolean) => void;
}

export function plot3dTools({ fit, exaggerate, showErrors }: Plot3dActions): HTMLElement[] {
  const button = (name: string, label: string, title: string, direction: Direction | null) =>
    h('button', { class: 'tab', 'data-view3d': name, title, onclick: () => fit(direction) }, label);
  const errors = h(
    'button',
    {
      class: 'tab',
      'data-role': 'plot3d-errors',
      'aria-pressed': 'true',
      title: 'Lines from the truth to the estimates at this instant',
      onclick: () => {
        const on = errors.getAttribute('aria-pressed') !== 'true';
        setAttribute(errors, 'aria-pressed', String(on));
        showErrors(on);
      },
    },
    'Errors',
  );
  const heights = h(
    'select',
    {
      'aria-label': 'Exaggeration of heights',
      title: 'Heights are drawn this many times as large',
      onchange: () => exaggerate(Number(heights.value)),
    },
    ...kHeightScales.map((scale) => h('option', { value: scale }, `Height ×${scale}`)),
  );
  return [
    button('oblique', 'Oblique', 'Everything, obliquely from above', 'oblique'),
    button('top', 'Top', 'Everything from above, north up', 'top'),
    button('side', 'Side', 'Everything from the south, up is up', 'side'),
    button('fit', 'Fit', 'Everything from the present direction (0, double click)', null),
    errors,
    heights,
  ];
}
