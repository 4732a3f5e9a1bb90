// A curve as the pixels to be joined.
import type { Polyline } from './curve';

/** Where times and values are on a canvas or in a file. */
export interface PixelScale {
  /** Pixel of the begin of the span, and of the greatest value. */
  left: number;
  top: number;
  begin_s: number;
  greatest: number;
  px_per_s: number;
  px_per_unit: number;
}

/** What draws: a canvas, a path, or a file. */
export interface LineSink {
  moveTo(x: number, y: number): void;
  lineTo(x: number, y: number): void;
}

/** A point that is left out is nearer than this to the line that is drawn. */
const kTolerance_px = 0.2;
/** From the top of the plot: a canvas does not draw lines to any distance. */
const kFarthest_px = 1e5;

/**
 * Draws a curve and leaves out points that would not change the picture: every line begins at the
 * end of the last one and goes on as long as it passes all points in between (Elmeleegy et al.,
 * Online Piece-wise Linear Approximation of Numerical Streams, VLDB 2009, "swing filter"). The time
 * that strokes take grows with their number.
 */
export function traceLine({ t_s, values }: Polyline, scale: PixelScale, sink: LineSink): void {
  const { left, top, begin_s, greatest, px_per_s, px_per_unit } = scale;
  /** Where the present line begins, and the last point that it reaches. */
  let [fromX, fromY, toX, toY] = [0, 0, 0, 0];
  let [flattest, steepest] = [-Infinity, Infinity];
  let drawing = false;
  for (let i = 0; i < t_s.length; i += 1) {
    const value = values[i] ?? NaN;
    if (value !== value) {
      if (drawing) sink.lineTo(toX, toY);
      drawing = false;
      continue;
    }
    const x = left + ((t_s[i] ?? 0) - begin_s) * px_per_s;
    const below_px = (greatest - value) * px_per_unit;
    const y = top + Math.min(kFarthest_px, Math.max(-kFarthest_px, below_px));
    if (!drawing) {
      sink.moveTo(x, y);
      drawing = true;
      [fromX, fromY] = [x, y];
      [flattest, steepest] = [-Infinity, Infinity];
      // A single point is drawn as well.
      [toX, toY] = [x + 0.01, y];
      continue;
    }
    let width = x - fromX;
    const slope = (y - fromY) / width;
    if (!(slope >= flattest && slope <= steepest)) {
      sink.lineTo(toX, toY);
      [fromX, fromY] = [toX, toY];
      [flattest, steepest] = [-Infinity, Infinity];
      width = x - fromX;
    }
    flattest = Math.max(flattest, (y - kTolerance_px - fromY) / width);
    steepest = Math.min(steepest, (y + kTolerance_px - fromY) / width);
    [toX, toY] = [x, y];
  }
  if (drawing) sink.lineTo(toX, toY);
}
