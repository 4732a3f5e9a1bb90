// Paints the curves of a plot over time.
import type { Polyline } from '../../store/plots/curve';
import type { PixelScale } from '../../store/plots/pixel_line';
import { traceLine } from '../../store/plots/pixel_line';
import type { CurveSpec } from '../../store/plots/plot_specs';
import { curveStyle } from '../colours';
import { paint } from '../paint';

/** Of many curves each is as thin as a browser without a GPU draws fast. */
const kMany = 8;
const kThin_px = 1;

export interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** @param ratio  pixels of the canvas / of the page */
export function paintCurves(
  pen: CanvasRenderingContext2D,
  specs: readonly CurveSpec[],
  lines: readonly Polyline[],
  box: Box,
  scale: PixelScale,
  ratio: number,
): void {
  pen.save();
  pen.beginPath();
  pen.rect(box.left, box.top, box.width, box.height);
  pen.clip();
  // Curves bend in nearly every pixel: round joins are not seen and take as long as the lines.
  pen.lineJoin = 'bevel';
  specs.forEach(({ hue }, i) => {
    const line = lines[i];
    if (line === undefined) return;
    const { colour, width_px, dash } = curveStyle(hue);
    pen.strokeStyle = paint(colour);
    pen.lineWidth = ratio * (specs.length > kMany ? Math.min(width_px, kThin_px) : width_px);
    pen.setLineDash(dash.map((part) => part * ratio));
    pen.beginPath();
    traceLine(line, scale, pen);
    pen.stroke();
  });
  pen.restore();
}
