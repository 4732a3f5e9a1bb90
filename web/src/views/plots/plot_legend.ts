// The line below the plots that names the curves and the states of the estimators.
import type { CurveHue, PlotSpec } from '../../store/plots/plot_specs';
import { curveStyle } from '../colours';
import { h, rebuild } from '../dom';
import { scrollRow } from '../scroll_row';
import { stateLegend } from '../status/state_lanes';

/** A plot over time has lanes, too. */
type Named = Pick<PlotSpec, 'lanes'> & { curves: readonly { name: string; hue: CurveHue }[] };

export class PlotLegend {
  readonly root: HTMLElement;
  private readonly names = h('div', {
    'data-role': 'plot-legend',
    role: 'group',
    'aria-label': 'Legend',
  });

  constructor() {
    this.root = scrollRow(this.names);
    this.root.classList.add('plot-legend');
    this.root.hidden = true;
  }

  /** Curves of the same name have the same colour in all plots. One curve needs no name. */
  show(specs: readonly Named[]): void {
    const hues = new Map<string, CurveHue>();
    for (const { curves } of specs) for (const { name, hue } of curves) hues.set(name, hue);
    hues.delete('');
    const [spec] = specs;
    const lanes = spec?.lanes ?? [];
    this.root.hidden = hues.size < 2 && lanes.length === 0;
    const states = new Set(lanes.flatMap(({ spans }) => spans().map(({ state }) => state)));
    rebuild(this.names, JSON.stringify([...hues, lanes.length, ...states]), () => [
      ...[...hues].map(([name, hue]) => {
        const { colour, dash } = curveStyle(hue);
        const dashed = dash.length > 0 ? 'dashed' : '';
        return h('span', {}, h('i', { class: dashed, style: `color:${colour}` }), name);
      }),
      ...(lanes.length === 0 ? [] : stateLegend(states)),
    ]);
  }
}
