// The tracks that the 3D plot shows: their points, which grow with the flight, and their lines.
import type { Point3 } from '../../store/plot3d/axis_box';
import { DisplayTrack } from '../../store/plot3d/display_track';
import type { ScreenMap } from '../../store/plot3d/orbit_view';
import { nearestOnTrack } from '../../store/plot3d/track_pick';
import type { State } from '../../store/state';
import { nearestIndex } from '../../store/table';
import { hueOf } from '../../store/plots/plot_specs';
import type { Track } from '../../store/tracks';
import { drawnTracks, tableOf } from '../../store/tracks';
import { curveStyle } from '../colours';
import { paint } from '../paint';
import type { LineStage } from './line_stage';
import { rgbOf } from './rgb';
import { TrackLine } from './track_line';

export interface ShownTrack {
  track: Track;
  points: DisplayTrack;
  line: TrackLine;
  generation: number;
}

/** A pose of a track. */
export interface TrackPlace {
  track: Track;
  place: Point3;
  /** Of the clock. */
  t_ns: number;
}

export class ShownTracks {
  private shown = new Map<string, ShownTrack>();

  constructor(private readonly stage: LineStage) {}

  get all(): readonly ShownTrack[] {
    return [...this.shown.values()];
  }

  get pointCount(): number {
    return this.all.reduce((sum, { points }) => sum + points.count, 0);
  }

  /** Takes the tracks as they are now. */
  take(state: State): void {
    const wanted = drawnTracks(state);
    const most = Math.floor(this.stage.mostPoints / Math.max(1, wanted.length));
    const before = this.shown;
    this.shown = new Map();
    wanted.forEach((track, order) => {
      const key = JSON.stringify([track.run.id, track.name, track.by]);
      const one = this.current(track, before.get(key));
      if (one === null) return;
      if (one === before.get(key)) before.delete(key);
      one.track = track;
      one.line.setPoints(one.points, one.points.extend(most));
      const style = curveStyle(hueOf(track));
      one.line.setStyle(style, rgbOf(paint(style.colour)), order);
      this.shown.set(key, one);
    });
    for (const { line } of before.values()) this.stage.remove(line);
  }

  setInstant(state: State, m_per_px: number): void {
    const t_ns = state.clock?.t_ns ?? Infinity;
    for (const { track, line } of this.shown.values()) {
      line.setInstant((t_ns - track.run.offset_ns) / 1e9, m_per_px);
    }
  }

  /** The pose that is nearest to a pixel. */
  nearest(map: ScreenMap, at: readonly [number, number], most_px: number): TrackPlace | null {
    let least_px = most_px;
    let found: TrackPlace | null = null;
    for (const { track, points } of this.shown.values()) {
      const picked = nearestOnTrack(points, map, at, least_px);
      if (picked === null) continue;
      least_px = picked.off_px;
      found = poseAt(track, points, picked.t_s);
    }
    return found;
  }

  /** What is shown already if it is still of these rows, else a new one; null without rows. */
  private current(track: Track, known: ShownTrack | undefined): ShownTrack | null {
    const table = tableOf(track);
    const { generation } = track.run.data;
    if (table === undefined) return null;
    if (known?.points.table === table && known.generation === generation) return known;
    const line = new TrackLine(this.stage.uniforms);
    this.stage.add(line);
    return { track, points: new DisplayTrack(table), line, generation };
  }
}

function poseAt(track: Track, { table }: DisplayTrack, t_s: number): TrackPlace {
  const row = nearestIndex(table.column('t_ns'), t_s * 1e9);
  return {
    track,
    place: [table.at('x_m', row), table.at('y_m', row), table.at('z_m', row)],
    t_ns: table.at('t_ns', row) + track.run.offset_ns,
  };
}
