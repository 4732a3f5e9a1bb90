// Names of runs and estimators at their aircraft, over the picture of the 3D view.
import type { SceneLabel } from '../../protocol/messages';
import { formatNumber } from '../../store/format';
import { placed, kWholePicture } from '../../store/pictures/picture_zoom';
import { placeLabels } from '../../store/scene/scene_labels';
import type { State } from '../../store/state';
import { tracksOf } from '../../store/tracks';
import type { Picture } from '../../store/watched_run';
import { estimateColour, kTruthColour } from '../colours';
import { h } from '../dom';

export interface LabelText {
  text: string;
  colour: string;
}

/** Error below this is not worth a number. */
const kLeastError_m = 0.05;

/** The text of a label, with the colour of its track; null for a run that is not watched now. */
export function labelText(state: State, label: SceneLabel): LabelText | null {
  const track = tracksOf(state).find(
    ({ run, name }) => run.id === label.run && name === (label.estimator ?? ''),
  );
  if (track === undefined) return null;
  const error_m = label.error_m ?? 0;
  const error = error_m < kLeastError_m ? '' : ` ${formatNumber(error_m, error_m < 10 ? 2 : 0)} m`;
  const colour = track.name === '' ? kTruthColour : estimateColour(track.colour);
  return { text: `${track.label}${error}`, colour };
}

export class LabelLayer {
  readonly root = h('div', { class: 'scene-labels', 'aria-hidden': 'true' });

  draw(state: State, picture: Picture | null): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (picture === null || width === 0) {
      this.root.replaceChildren();
      return;
    }
    const size = { width: picture.width_px, height: picture.height_px };
    const rect = placed({ width, height }, size, kWholePicture);
    const entries = picture.labels.flatMap((label) => {
      const text = labelText(state, label);
      if (text === null) return [];
      const element = h(
        'span',
        { class: 'scene-label', style: `border-color:${text.colour}` },
        text.text,
      );
      const x = rect.x + ((label.x_px + 0.5) / size.width) * rect.width;
      const y = rect.y + ((label.y_px + 0.5) / size.height) * rect.height;
      return [{ element, x, y, colour: text.colour }];
    });
    this.root.replaceChildren(...entries.map(({ element }) => element));
    const boxes = entries.map(({ element, x, y }) => ({
      x,
      y,
      width: element.offsetWidth,
      height: element.offsetHeight,
    }));
    placeLabels(boxes, { width, height }).forEach(({ left, top }, i) => {
      const [entry, box] = [entries[i], boxes[i]];
      if (entry === undefined || box === undefined) return;
      entry.element.style.left = `${left}px`;
      entry.element.style.top = `${top}px`;
      this.root.append(leader(left + box.width / 2, top + box.height, entry));
    });
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
