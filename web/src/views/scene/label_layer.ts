// Names of runs and estimators at their aircraft, over the picture of the 3D view.
import type { SceneLabel } from '../../protocol/messages';
import { formatNumber } from '../../store/format';
import { placed, kWholePicture } from '../../store/pictures/picture_zoom';
import { placeLabels } from '../../store/scene/scene_labels';
import type { State } from '../../store/state';
import { tracksOf } from '../../store/tracks';
import type { Picture } from '../../store/watched_run';
import { trackColour } from '../colours';
import { h, rebuild } from '../dom';

export interface LabelText {
  text: string;
  colour: string;
}

/** Error below this is not worth a number. */
const kLeastError_m = 0.05;

/** The text of a label, with the colour of its track; null if that is not shown or not watched now. */
export function labelText(state: State, label: SceneLabel): LabelText | null {
  const track = tracksOf(state).find(
    ({ run, name }) => run.id === label.run && name === (label.estimator ?? ''),
  );
  if (track === undefined || !track.shown) return null;
  const error_m = label.error_m ?? 0;
  const error = error_m < kLeastError_m ? '' : ` ${formatNumber(error_m, error_m < 10 ? 2 : 0)} m`;
  return { text: `${track.label}${error}`, colour: trackColour(track) };
}

interface PlacedLabel extends LabelText {
  /** What it belongs to, in the layer. */
  x: number;
  y: number;
}

/** Padding and border of .scene-label, beside its text. */
const kFrame_px = 15;
/** Line height of .scene-label. */
const kHeight_px = 16;

export class LabelLayer {
  readonly root = h('div', { class: 'scene-labels', 'aria-hidden': 'true' });
  /** Kept by an observer, and texts measured on a canvas: asking elements causes a layout per picture. */
  private size = { width: 0, height: 0 };
  private readonly pen = h('canvas').getContext('2d');
  private drawn: { state: State; picture: Picture | null } | null = null;

  constructor() {
    new ResizeObserver(() => {
      this.size = { width: this.root.clientWidth, height: this.root.clientHeight };
      if (this.pen !== null) this.pen.font = `11px ${getComputedStyle(this.root).fontFamily}`;
      if (this.drawn !== null) this.draw(this.drawn.state, this.drawn.picture);
    }).observe(this.root);
  }

  draw(state: State, picture: Picture | null): void {
    this.drawn = { state, picture };
    const labels = picture === null || this.size.width === 0 ? [] : this.placed(state, picture);
    rebuild(this.root, JSON.stringify([this.size, labels]), () => this.elements(labels));
  }

  private placed(state: State, picture: Picture): PlacedLabel[] {
    const size = { width: picture.width_px, height: picture.height_px };
    const rect = placed(this.size, size, kWholePicture);
    return picture.labels.flatMap((label) => {
      const text = labelText(state, label);
      if (text === null) return [];
      const x = rect.x + ((label.x_px + 0.5) / size.width) * rect.width;
      const y = rect.y + ((label.y_px + 0.5) / size.height) * rect.height;
      return [{ ...text, x, y }];
    });
  }

  private elements(labels: readonly PlacedLabel[]): HTMLElement[] {
    const boxes = labels.map(({ text, x, y }) => ({
      x,
      y,
      width: kFrame_px + Math.ceil(this.pen?.measureText(text).width ?? 0),
      height: kHeight_px,
    }));
    const names: HTMLElement[] = [];
    const leaders: HTMLElement[] = [];
    placeLabels(boxes, this.size).forEach(({ left, top }, i) => {
      const [label, box] = [labels[i], boxes[i]];
      if (label === undefined || box === undefined) return;
      const style = `left:${left}px;top:${top}px;border-color:${label.colour}`;
      names.push(h('span', { class: 'scene-label', style }, label.text));
      leaders.push(leader(left + box.width / 2, top + box.height, label));
    });
    return [...names, ...leaders];
  }
}

/** From a label to what it belongs to. */
function leader(x: number, y: number, to: { x: number; y: number; colour: string }): HTMLElement {
  const [dx, dy] = [to.x - x, to.y - y];
  const length = Math.hypot(dx, dy);
  const angle = Math.atan2(dy, dx);
  return h('i', {
    class: 'scene-leader',
    style: `left:${x}px;top:${y}px;width:${length}px;transform:rotate(${angle}rad);background:${to.colour}`,
  });
}
