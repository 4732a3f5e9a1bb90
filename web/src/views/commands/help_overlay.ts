// The list of keyboard shortcuts.
import type { Topic } from '../../store/state';
import { h } from '../dom';
import { kShortcuts } from './shortcuts';
import type { Context, View } from '../view';

export class HelpOverlay implements View {
  readonly root: HTMLElement;

  constructor(private readonly context: Context) {
    const rows = kShortcuts.map(({ label, what }) =>
      h(
        'tr',
        {},
        h('td', {}, ...label.split(' ').map((key) => h('kbd', {}, key))),
        h('td', {}, what),
      ),
    );
    const mouse = [
      ['Drag in 3D', 'turn the view'],
      ['Wheel in 3D', 'zoom'],
      ['Double-click in 3D', 'toggle following the aircraft'],
      ['W A S D, Q E in 3D', 'fly in the free view; Shift = faster'],
      ['Wheel in a picture', 'zoom; all pictures of a camera follow'],
      ['Drag in a zoomed picture', 'move it'],
      ['Double-click in a picture', 'show it whole'],
      ['Click or drag in a plot', 'seek'],
      ['Wheel in a plot', 'zoom in time'],
      [
        'Shift and wheel or drag in a plot',
        'move in time; also middle or right button, two fingers',
      ],
      ['+ − 0 ← → on plots (Tab)', 'zoom, whole flight, move in time'],
      ['Double-click in a plot', 'show the whole flight'],
    ].map(([what = '', does = '']) => h('tr', {}, h('td', {}, what), h('td', {}, does)));
    this.root = h(
      'div',
      { class: 'overlay', hidden: true, onclick: () => this.close() },
      h(
        'div',
        { class: 'help', role: 'dialog', 'aria-label': 'Keyboard shortcuts' },
        h('h2', {}, 'Keyboard and mouse'),
        h('table', {}, h('tbody', {}, ...rows, ...mouse)),
      ),
    );
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('help')) this.root.hidden = !this.context.store.state.helpOpen;
  }

  private close(): void {
    this.context.store.state.helpOpen = false;
    this.context.store.change('help');
  }
}
