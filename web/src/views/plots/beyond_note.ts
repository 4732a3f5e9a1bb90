// Names the estimates that a plot leaves out because they are far beyond the others.
import type { CurveHue } from '../../store/plots/plot_specs';
import { beyondText } from '../../store/plots/shared_extent';
import { curveStyle } from '../colours';
import { h, rebuild } from '../dom';

const kHint =
  'Its values are so large that the others would be one line. Hide the others to see all of it.';

export class BeyondNote {
  readonly root = h('div', { class: 'plot-beyond', title: kHint });

  /** Nothing is shown without names. */
  show(curves: readonly { name: string; hue: CurveHue }[]): void {
    rebuild(this.root, JSON.stringify(curves.map(({ name, hue }) => [name, hue])), () =>
      curves.map(({ name, hue }) =>
        h('span', { style: `color:${curveStyle(hue).colour}` }, beyondText(name)),
      ),
    );
  }
}
