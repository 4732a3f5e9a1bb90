// A picture of the board with the corners that were found, and the residuals of an estimate.
import type { Corner, SearchedImage } from '../../protocol/calibration_types';
import { NewestLoader } from '../../store/calibration/newest_loader';
import { h, setText } from '../dom';

/** Residuals are a fraction of a pixel: they are drawn longer by this factor. */
export const kResidualScale = 100;
const kTaken = '#5fd07a';
const kSeen = '#ffc857';
const kResidual = '#ff6fae';

export interface BoardPictureContent {
  image: SearchedImage;
  url: string;
  caption: string;
  /** Inner corners in a row; lines join those of a complete board. */
  cols: number;
  rows: number;
  residuals: (Corner | null)[] | null;
}

export class BoardPicture {
  readonly root: HTMLElement;
  private readonly canvas = h('canvas', { class: 'board-canvas', role: 'img' });
  private readonly caption = h('figcaption', {});
  private readonly empty = h('div', { class: 'board-empty' });
  private key = '';
  private content: BoardPictureContent | null = null;
  private picture: HTMLImageElement | null = null;
  /** The picture before stays until the next one is there, so that nothing flickers. */
  private readonly loader = new NewestLoader(
    ({ url }: BoardPictureContent) => decoded(url),
    (content, picture) => this.take(content, picture),
  );

  constructor(
    label: string,
    private readonly hint: string,
  ) {
    this.canvas.setAttribute('aria-label', label);
    this.root = h(
      'figure',
      { class: 'board-picture', 'data-role': label.toLowerCase().replaceAll(' ', '-') },
      h('div', { class: 'board-frame' }, this.canvas, this.empty),
      this.caption,
    );
    new ResizeObserver(() => this.draw()).observe(this.root);
  }

  show(content: BoardPictureContent | null): void {
    const { image, url, caption, residuals } = content ?? {};
    const key = JSON.stringify([url, caption, image?.verdict, residuals !== null, residuals?.[0]]);
    if (key === this.key) return;
    this.key = key;
    this.root.dataset['image'] = image === undefined ? '' : String(image.number);
    if (content === null || !content.image.picture) {
      this.loader.clear();
      this.take(content, null);
      return;
    }
    this.loader.want(content);
  }

  private take(content: BoardPictureContent | null, picture: HTMLImageElement | null): void {
    this.content = content;
    this.picture = picture;
    setText(this.caption, content?.caption ?? '');
    const { width_px, height_px } = content?.image ?? { width_px: 0, height_px: 0 };
    if (width_px > 0) this.root.style.setProperty('--aspect', `${width_px / height_px}`);
    this.canvas.hidden = this.picture === null;
    this.empty.hidden = this.picture !== null;
    setText(this.empty, content === null ? this.hint : content.image.verdict);
    this.draw();
  }

  private draw(): void {
    const { picture, content, canvas } = this;
    if (picture === null || content === null) return;
    const { width_px, height_px } = content.image;
    const frame = this.canvas.parentElement;
    if (frame === null || width_px === 0) return;
    const fit = Math.min(frame.clientWidth / width_px, frame.clientHeight / height_px);
    if (!(fit > 0)) return;
    const ratio = window.devicePixelRatio;
    canvas.style.width = `${width_px * fit}px`;
    canvas.style.height = `${height_px * fit}px`;
    canvas.width = Math.round(width_px * fit * ratio);
    canvas.height = Math.round(height_px * fit * ratio);
    const pen = canvas.getContext('2d');
    if (pen === null) return;
    pen.drawImage(picture, 0, 0, canvas.width, canvas.height);
    const scale = fit * ratio;
    // Pixel centres are at integers.
    const place = ([x, y]: Corner): Corner => [(x + 0.5) * scale, (y + 0.5) * scale];
    drawCorners(pen, content, place, ratio);
    if (content.residuals !== null) drawResiduals(pen, content, place, scale, ratio);
  }
}

async function decoded(url: string): Promise<HTMLImageElement> {
  const image = new Image();
  image.src = url;
  await image.decode();
  return image;
}

function drawCorners(
  pen: CanvasRenderingContext2D,
  { image, cols, rows }: BoardPictureContent,
  place: (corner: Corner) => Corner,
  ratio: number,
): void {
  const corners = image.corners.map(place);
  pen.strokeStyle = image.verdict === 'taken' ? kTaken : kSeen;
  pen.lineWidth = 1.25 * ratio;
  if (corners.length === cols * rows) {
    pen.beginPath();
    corners.forEach(([x, y], i) => (i === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
    pen.globalAlpha = 0.5;
    pen.stroke();
    pen.globalAlpha = 1;
  }
  const radius = Math.min(3.5 * ratio, 0.25 * spacing(corners));
  corners.forEach(([x, y], i) => {
    pen.beginPath();
    // The first corner is larger: it shows the board's orientation.
    pen.arc(x, y, (i === 0 ? 2 : 1) * radius, 0, 2 * Math.PI);
    pen.stroke();
  });
}

/** Distance of the first two corners, which are neighbours. */
function spacing([first, second]: readonly Corner[]): number {
  if (first === undefined || second === undefined) return Infinity;
  return Math.hypot(second[0] - first[0], second[1] - first[1]);
}

function drawResiduals(
  pen: CanvasRenderingContext2D,
  { image, residuals }: BoardPictureContent,
  place: (corner: Corner) => Corner,
  scale: number,
  ratio: number,
): void {
  pen.strokeStyle = kResidual;
  pen.lineWidth = 2 * ratio;
  pen.beginPath();
  image.corners.forEach((corner, i) => {
    const residual = residuals?.[i];
    if (residual === null || residual === undefined) return;
    const [x, y] = place(corner);
    pen.moveTo(x, y);
    pen.lineTo(x + residual[0] * kResidualScale * scale, y + residual[1] * kResidualScale * scale);
  });
  pen.stroke();
}
