// The 3D plot as a file. Its lines are projected as the GPU does it, without hidden parts: tracks are
// thin, and those that are drawn later lie above.
import { kGap_s, kPointSize } from '../../store/plot3d/display_track';
import type { ScreenMap } from '../../store/plot3d/orbit_view';
import { toScreen } from '../../store/plot3d/orbit_view';
import type { Size } from '../../store/plots/path_frame';
import { kTop_px, svgTitles } from '../../store/plots/plot_export';
import type { Pen } from '../../store/plots/svg_pen';
import { clipped, SvgPen, svgFile } from '../../store/plots/svg_pen';
import { hueOf } from '../../store/plots/plot_specs';
import { curveStyle } from '../colours';
import { paint } from '../paint';
import type { ShownTrack } from './shown_tracks';
import { kBroader_px, kLaterWidth } from './track_line';

const kMargin_px = 9;
/** Points nearer than this to the last one are not drawn. */
const kLeastStep_px = 0.5;

/**
 * @param others  draws what lies below the tracks, and above them
 * @param clock_ns  up to it tracks are bold
 */
export function plot3dSvg(
  tracks: readonly ShownTrack[],
  map: ScreenMap,
  size: Size,
  clock_ns: number,
  others: { below: (pen: Pen) => void; above: (pen: Pen) => void },
): string {
  const { width_px, height_px } = size;
  const pen = new SvgPen();
  others.below(pen);
  for (const track of tracks) drawTrack(pen, track, map, clock_ns);
  others.above(pen);
  const names = tracks.map(({ track }) => ({
    name: track.label,
    colour: paint(curveStyle(hueOf(track)).colour),
  }));
  return svgFile(
    width_px,
    height_px + kTop_px,
    paint('var(--panel)'),
    svgTitles(kMargin_px, 'Tracks [m]', names, paint('var(--text)')) +
      clipped(0, kTop_px, width_px, height_px, pen.content),
  );
}

function drawTrack(
  pen: Pen,
  { track, points }: ShownTrack,
  map: ScreenMap,
  clock_ns: number,
): void {
  const { colour, width_px, dash } = curveStyle(hueOf(track));
  const now_s = (clock_ns - track.run.offset_ns) / 1e9;
  pen.strokeStyle = paint(colour);
  pen.lineJoin = 'round';
  for (const later of [true, false]) {
    pen.lineWidth = (width_px + kBroader_px) * (later ? kLaterWidth : 1);
    pen.setLineDash(dash);
    drawPart(pen, points, map, (t_s) => (later ? t_s >= now_s : t_s <= now_s));
  }
  pen.setLineDash([]);
}

function drawPart(
  pen: Pen,
  { points, count }: ShownTrack['points'],
  map: ScreenMap,
  shown: (t_s: number) => boolean,
): void {
  pen.beginPath();
  let last: readonly [number, number] | null = null;
  for (let i = 0; i < count * kPointSize; i += kPointSize) {
    const [x = NaN, y = NaN, z = NaN, t_s = kGap_s] = points.subarray(i, i + 4);
    if (t_s === kGap_s || !shown(t_s)) {
      last = null;
      continue;
    }
    const at = toScreen(map, [x, y, z]);
    if (last === null) pen.moveTo(...at);
    else if (Math.hypot(at[0] - last[0], at[1] - last[1]) < kLeastStep_px) continue;
    else pen.lineTo(...at);
    last = at;
  }
  pen.stroke();
}
