// What is known of the place under the mouse: run, track, time and coordinates.
import { formatNumber, formatTime } from '../../store/format';
import type { ScreenMap } from '../../store/plot3d/orbit_view';
import { toScreen } from '../../store/plot3d/orbit_view';
import type { Size } from '../../store/plots/path_frame';
import { distinguishingNames } from '../../store/run_names';
import type { State } from '../../store/state';
import { trackColour } from '../colours';
import { h, setText } from '../dom';
import type { TrackPlace } from './shown_tracks';

const kOff_px = 12;

export class HoverNote {
  private readonly dot = h('div', { class: 'plot3d-dot', hidden: true });
  private readonly track = h('b');
  private readonly run = h('span');
  private readonly time = h('div');
  private readonly place = h('div');
  private readonly box = h(
    'div',
    { class: 'plot3d-note', 'data-role': 'plot3d-note', hidden: true },
    h('div', {}, this.track, ' ', this.run),
    this.time,
    this.place,
  );
  readonly parts: readonly HTMLElement[] = [this.dot, this.box];

  show({ track, place, t_ns }: TrackPlace, map: ScreenMap, size: Size, state: State): void {
    const names = distinguishingNames(state.watched.flatMap(({ run }) => run ?? []));
    setText(this.track, track.label);
    setText(this.run, track.letter === '' ? '' : (names.get(track.run.id) ?? track.run.id));
    setText(this.time, formatTime(t_ns));
    const [x, y, z] = place.map((part) => formatNumber(part, 1));
    setText(this.place, `x ${x}  y ${y}  z ${z} m`);
    const [left, top] = toScreen(map, place);
    this.dot.style.cssText = `left:${left}px;top:${top}px;color:${trackColour(track)}`;
    for (const part of this.parts) part.hidden = false;
    const { offsetWidth, offsetHeight } = this.box;
    const right = left + kOff_px + offsetWidth > size.width_px ? -kOff_px - offsetWidth : kOff_px;
    const below = top + kOff_px + offsetHeight > size.height_px ? -kOff_px - offsetHeight : kOff_px;
    this.box.style.left = `${Math.max(0, left + right)}px`;
    this.box.style.top = `${Math.max(0, top + below)}px`;
  }

  hide(): void {
    for (const part of this.parts) part.hidden = true;
  }
}
