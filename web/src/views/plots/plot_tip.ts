// The list next to the mouse on a plot: every curve with its name, value and unit.
import { formatNumber } from '../../store/format';
import { hoverRows } from '../../store/plots/hover_values';
import type { CurveHue } from '../../store/plots/plot_specs';
import { curveStyle } from '../colours';
import { h, setAttribute, setText } from '../dom';

const kOff_px = 14;
/** More curves do not fit next to a mouse. */
const kMostRows = 18;

/** What is pointed at. */
export interface TipPlot {
  label: string;
  unit: string;
  digits: number;
  curves: readonly { name: string; hue: CurveHue }[];
}

export interface PointedAt {
  /** Of the window [px]. */
  x: number;
  y: number;
  /** On the plot's axes: a time or a length, and a value. */
  place: string;
  value: number;
  /** Of estimators that do not track then. */
  states: readonly string[];
}

const kMostNotes = 8;

interface Row {
  root: HTMLElement;
  swatch: HTMLElement;
  name: HTMLElement;
  value: HTMLElement;
}

/** There is one mouse, so all plots have one list. */
class PlotTip {
  private readonly title = h('div', { class: 'plot-tip-title' });
  private readonly list = h('div', { class: 'plot-tip-rows' });
  private readonly more = h('div', { class: 'plot-tip-more' });
  // The values next to the plots' titles are for everybody; these follow the mouse.
  private readonly root = h(
    'div',
    { class: 'plot-tip', 'data-role': 'plot-tip', 'aria-hidden': 'true', hidden: true },
    this.title,
    this.list,
    this.more,
  );
  private readonly rows: Row[] = [];

  show(plot: TipPlot, values: readonly (number | null)[], at: PointedAt): void {
    const { label, unit, digits, curves } = plot;
    const { rows, nearest, more } = hoverRows(values, at.value, kMostRows);
    if (rows.length + at.states.length === 0) {
      this.hide();
      return;
    }
    if (!this.root.isConnected) document.body.append(this.root);
    setText(this.title, `${label} · ${at.place}`);
    const notes = more === 0 ? at.states : [`${more} more, farther from the mouse`, ...at.states];
    setText(this.more, notes.slice(0, kMostNotes).join('\n'));
    rows.forEach(({ index, value }, i) => {
      const row = this.row(i);
      const { colour, dash } = curveStyle(curves[index]?.hue ?? { kind: 'run', order: 0 });
      setAttribute(row.swatch, 'class', dash.length > 0 ? 'dashed' : '');
      setAttribute(row.swatch, 'style', `color:${colour}`);
      setText(row.name, curves[index]?.name ?? '');
      setText(
        row.value,
        unit === '' ? formatNumber(value, digits) : `${formatNumber(value, digits)} ${unit}`,
      );
      setAttribute(row.root, 'data-nearest', index === nearest ? 'true' : null);
    });
    this.list.replaceChildren(...this.rows.slice(0, rows.length).map(({ root }) => root));
    this.root.hidden = false;
    this.place(at);
  }

  hide(): void {
    this.root.hidden = true;
  }

  private row(index: number): Row {
    const known = this.rows[index];
    if (known !== undefined) return known;
    const [swatch, name, value] = [h('i'), h('span'), h('b')];
    const made = { root: h('div', {}, swatch, name, value), swatch, name, value };
    this.rows.push(made);
    return made;
  }

  /** Next to the mouse, and inside the window. */
  private place({ x, y }: PointedAt): void {
    const { offsetWidth, offsetHeight } = this.root;
    const left = x + kOff_px + offsetWidth > innerWidth ? x - kOff_px - offsetWidth : x + kOff_px;
    const top = Math.min(y + kOff_px, innerHeight - offsetHeight - 4);
    this.root.style.left = `${Math.max(0, left)}px`;
    this.root.style.top = `${Math.max(0, top)}px`;
  }
}

export const plotTip = new PlotTip();
