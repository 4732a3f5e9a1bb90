// A canvas that shows the newest picture of a stream with its aspect ratio.
import type { Picture } from '../../store/watched_run';
import { h } from '../dom';

const kOldest_ns = 1e9;

export class PictureCanvas {
  readonly canvas: HTMLCanvasElement;
  private shown: Picture | null = null;

  constructor(label: string) {
    this.canvas = h('canvas', { class: 'picture', role: 'img', 'aria-label': label });
  }

  show(picture: Picture | null): void {
    if (picture === this.shown) return;
    this.shown = picture;
    this.canvas.style.visibility = picture === null ? 'hidden' : 'visible';
    if (picture === null) return;
    if (this.canvas.width !== picture.width_px || this.canvas.height !== picture.height_px) {
      this.canvas.width = picture.width_px;
      this.canvas.height = picture.height_px;
    }
    this.canvas.getContext('2d', { alpha: false })?.drawImage(picture.bitmap, 0, 0);
  }

  /** Fades a picture that does not belong to the playback's instant. */
  markStale(cursor_ns: number | null): void {
    const picture = this.shown;
    const stale =
      picture !== null &&
      cursor_ns !== null &&
      (picture.t_ns > cursor_ns || picture.t_ns < cursor_ns - kOldest_ns);
    this.canvas.classList.toggle('stale', stale);
  }
}
