// A canvas that fills an area of the page, painted once per animation frame, on the screen or into a file.
import type { Size } from '../../store/plots/path_frame';
import { kTop_px, svgTitles } from '../../store/plots/plot_export';
import type { CurveHue } from '../../store/plots/plot_specs';
import type { Pen } from '../../store/plots/svg_pen';
import { clipped, svgFile, SvgPen } from '../../store/plots/svg_pen';
import { curveStyle } from '../colours';
import { h, perFrame } from '../dom';
import { paint } from '../paint';

/** A part of a file [px]. */
export interface Drawing {
  width: number;
  height: number;
  content: string;
}

export class PlotCanvas {
  readonly canvas = h('canvas', { role: 'img' });
  readonly area = h('div', { class: 'path-area' }, this.canvas);
  private readonly repaintInFrame = perFrame<null>(() => this.paintNow());

  /**
   * @param paintAll  draws everything into an area of this size
   * @param least     nothing is painted into less
   */
  constructor(
    private readonly paintAll: (pen: Pen, size: Size) => void,
    private readonly least: Size,
  ) {
    new ResizeObserver(() => this.repaint()).observe(this.area);
  }

  size(): Size {
    return { width_px: this.area.clientWidth, height_px: this.area.clientHeight };
  }

  repaint(): void {
    this.repaintInFrame(null);
  }

  private paintNow(): void {
    const size = this.size();
    if (size.width_px < this.least.width_px || size.height_px < this.least.height_px) return;
    const ratio = window.devicePixelRatio;
    this.canvas.width = Math.round(size.width_px * ratio);
    this.canvas.height = Math.round(size.height_px * ratio);
    const pen = this.canvas.getContext('2d');
    if (pen === null) return;
    pen.scale(ratio, ratio);
    this.paintAll(pen, size);
  }

  /** As it is shown, below a title and the names of the curves; the title begins at `left_px`. */
  drawing(
    left_px: number,
    title: string,
    curves: readonly { name: string; hue: CurveHue }[],
  ): Drawing {
    const size = this.size();
    const pen = new SvgPen();
    this.paintAll(pen, size);
    const names = curves.map(({ name, hue }) => ({ name, colour: paint(curveStyle(hue).colour) }));
    return {
      width: size.width_px,
      height: size.height_px + kTop_px,
      content:
        svgTitles(left_px, title, names, paint('var(--text)')) +
        clipped(0, kTop_px, size.width_px, size.height_px, pen.content),
    };
  }
}

/** A file with drawings from left to right. */
export function sideBySide(drawings: readonly Drawing[]): string {
  let left = 0;
  const parts = drawings.map(({ width, content }) => {
    left += width;
    return `<g transform="translate(${left - width} 0)">${content}</g>`;
  });
  const height = Math.max(...drawings.map((one) => one.height));
  return svgFile(left, height, paint('var(--panel)'), parts.join(''));
}
