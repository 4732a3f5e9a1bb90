// The residuals of each view: root mean square as a bar, the largest as a mark. A click shows the
// view.
import { formatNumber } from '../../store/format';
import type { ViewRow } from '../../store/calibration/calibration_results';
import { h, rebuild } from '../dom';

export class ResidualBars {
  readonly root = h('div', { class: 'residual-plot', 'data-role': 'residual-plot' });

  constructor(private readonly onSelect: (view: number) => void) {}

  /** @param rms_px  of all views; null without an estimate */
  show(rows: readonly ViewRow[], rms_px: number | null, selected: number | null): void {
    rebuild(this.root, JSON.stringify([rows, rms_px, selected]), () => {
      this.root.hidden = rms_px === null;
      if (rms_px === null) return [];
      const top_px = niceTop(Math.max(...rows.map(({ max_px }) => max_px ?? 0), rms_px));
      const title = h(
        'div',
        { class: 'residual-title' },
        'Residuals of each view: RMS and largest',
      );
      return [title, axis(top_px), this.bars(rows, rms_px, top_px, selected)];
    });
  }

  private bars(
    rows: readonly ViewRow[],
    rms_px: number,
    top_px: number,
    selected: number | null,
  ): HTMLElement {
    const at = (value_px: number) => `${(100 * value_px) / top_px}%`;
    return h(
      'div',
      { class: 'residual-area' },
      ...[1, 0.5].map((share) =>
        h('div', { class: 'residual-grid', style: `bottom:${100 * share}%` }),
      ),
      h('div', {
        class: 'residual-mean',
        style: `bottom:${at(rms_px)}`,
        title: `RMS of all views: ${formatNumber(rms_px, 3)} px`,
      }),
      h(
        'div',
        { class: 'residual-columns' },
        ...rows.map((row) => this.column(row, at, row.view === selected)),
      ),
    );
  }

  private column(
    { view, name, rms_px, max_px, leftOut, outlier }: ViewRow,
    at: (value_px: number) => string,
    selected: boolean,
  ): HTMLElement {
    const figures =
      rms_px === null || max_px === null
        ? leftOut
          ? 'left out'
          : 'not in the estimate'
        : `RMS ${formatNumber(rms_px, 3)} px, largest ${formatNumber(max_px, 3)} px`;
    return h(
      'button',
      {
        class: outlier ? 'residual-column outlier' : 'residual-column',
        'data-view': view,
        'aria-pressed': selected ? 'true' : 'false',
        'aria-label': `View ${view + 1}, ${name}: ${figures}`,
        title: `View ${view + 1}, ${name}: ${figures}`,
        onclick: () => this.onSelect(view),
      },
      rms_px === null ? null : h('span', { class: 'residual-rms', style: `height:${at(rms_px)}` }),
      max_px === null ? null : h('span', { class: 'residual-max', style: `bottom:${at(max_px)}` }),
    );
  }
}

function axis(top_px: number): HTMLElement {
  return h(
    'div',
    { class: 'residual-axis', 'aria-hidden': 'true' },
    h('span', {}, `${formatNumber(top_px, 2)} px`),
    h('span', {}, formatNumber(top_px / 2, 2)),
    h('span', {}, '0'),
  );
}

/** The next of 1, 2, 5 times a power of ten. */
export function niceTop(largest: number): number {
  if (!(largest > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(largest));
  return ([1, 2, 5].find((step) => step * power >= largest) ?? 10) * power;
}
