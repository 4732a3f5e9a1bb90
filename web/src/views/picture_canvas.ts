// A canvas that shows the newest picture of a stream, in its own proportions.
import type { Picture } from '../store/state';
import { h } from './dom';

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
}
