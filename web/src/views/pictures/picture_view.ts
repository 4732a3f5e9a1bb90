// One picture: zoomed and moved together with the others of its camera, with a mark where the mouse
// points, what the pixel there shows, and a legend if its colours stand for values.
import type { PixelQuestion } from '../../protocol/pixel_types';
import { formatNumber } from '../../store/format';
import { gradient, ticksOf } from '../../store/pictures/colour_scale';
import {
  kWholePicture,
  panned,
  pixelAt,
  placed,
  shareAt,
  widthWanted,
  zoomedAt,
} from '../../store/pictures/picture_zoom';
import type { Point, Rect, Size, Zoom } from '../../store/pictures/picture_zoom';
import { pixelTexts } from '../../store/pictures/pixel_probe';
import { shownAlignment } from '../../store/state';
import type { Picture, WatchedRun } from '../../store/watched_run';
import { h, rebuild, setText } from '../dom';
import type { Context } from '../view';

/** What a view shows. */
export interface PictureCell {
  watched: WatchedRun;
  picture: Picture | null;
  /** Over the picture: the run's letter, '' for the only run. */
  title: string;
  /** Key of the pictures that show the same place. */
  group: string;
  /** What a pixel is asked about; null = it is no camera's picture. */
  asks: Pick<PixelQuestion, 'camera' | 'picture'> | null;
  /** Of the values that the colours stand for. */
  legend: { of: 'depth' | 'error'; label: string } | null;
  /** Shown while there is no picture. */
  empty: string;
}

const kOldest_ns = 1e9;
const kZoomPerPixel = 0.0016;
const kKeyZoom = 1.25;
const kKeyPan = 0.12;
/** From this size of a pixel on its edges are shown. */
const kSharp_px = 3;

export class PictureView {
  readonly root: HTMLElement;
  /** For what lies over the picture's upper edge. */
  readonly marks = h('div', { class: 'fault-marks' });
  private readonly canvas = h('canvas', { class: 'picture' });
  private readonly title = h('span', { class: 'picture-title' });
  private readonly cross = h('div', { class: 'picture-cross', hidden: true });
  private readonly readout = h('div', { class: 'picture-readout', role: 'status', hidden: true });
  private readonly legend = h('div', { class: 'colour-legend', hidden: true });
  private readonly empty = h('div', { class: 'panel-empty', hidden: true });
  private readonly pointers = new Map<number, Point>();
  private cell: PictureCell | null = null;
  private drawn: Picture | null = null;
  /** Where the mouse points, in the area; null = elsewhere. */
  private pointed: Point | null = null;
  /** Kept by an observer: reading a size from the element would cause a layout for each picture. */
  private area: Size = { width: 0, height: 0 };

  constructor(
    private readonly context: Context,
    label: string,
    onResized: () => void,
  ) {
    this.root = h(
      'div',
      {
        class: 'picture-view',
        tabindex: 0,
        role: 'img',
        'aria-label': `${label}: zoom with plus and minus, move with the arrows, 0 shows all`,
      },
      this.canvas,
      this.cross,
      this.marks,
      this.title,
      this.legend,
      this.readout,
      this.empty,
    );
    this.listen();
    new ResizeObserver(() => {
      this.area = { width: this.root.clientWidth, height: this.root.clientHeight };
      this.place();
      onResized();
    }).observe(this.root);
  }

  /** @param cursor_ns  of the run, while the playback stands still */
  show(cell: PictureCell, cursor_ns: number | null): void {
    this.cell = cell;
    const { picture } = cell;
    this.draw(picture);
    setText(this.title, cell.title);
    this.title.hidden = cell.title === '';
    this.empty.hidden = picture !== null;
    setText(this.empty, picture === null ? cell.empty : '');
    const stale =
      picture !== null &&
      cursor_ns !== null &&
      (picture.t_ns > cursor_ns || picture.t_ns < cursor_ns - kOldest_ns);
    this.canvas.classList.toggle('stale', stale);
    this.drawLegend(cell);
    this.place();
    this.point();
  }

  /** The mark and the read-out. */
  showHover(): void {
    const { hover, pixel } = this.context.store.state;
    const rect = this.rect();
    const marked = rect !== null && hover !== null && hover.group === this.cell?.group;
    this.cross.hidden = !marked;
    if (marked) {
      this.cross.style.left = `${rect.x + hover.x * rect.width}px`;
      this.cross.style.top = `${rect.y + hover.y * rect.height}px`;
    }
    const own = this.pointed !== null && marked && hover.run === this.cell?.watched.id;
    this.readout.hidden = !own || pixel === null;
    if (!own || pixel === null) return;
    const { question, answer } = pixel;
    const texts = typeof answer === 'string' ? [answer] : pixelTexts(question, answer);
    rebuild(this.readout, JSON.stringify(texts), () => texts.map((text) => h('span', {}, text)));
  }

  /** Places the picture for the zoom of its group. */
  place(): void {
    const rect = this.rect();
    if (rect === null) return;
    const { style } = this.canvas;
    style.left = `${rect.x}px`;
    style.top = `${rect.y}px`;
    style.width = `${rect.width}px`;
    style.height = `${rect.height}px`;
    const pixel = (rect.width * window.devicePixelRatio) / this.canvas.width;
    style.imageRendering = pixel >= kSharp_px ? 'pixelated' : 'auto';
    this.root.classList.toggle('zoomed', this.zoom.scale > 1);
    this.showHover();
  }

  /** The width of a picture that has enough pixels for the place where it is shown; 0 = it is not shown. */
  get width_px(): number {
    if (this.area.width === 0) return 0;
    return widthWanted(this.area, this.zoom, window.devicePixelRatio);
  }

  leave(): void {
    if (this.pointed !== null) this.context.probe.point(null);
    this.pointed = null;
  }

  private get zoom(): Zoom {
    const { zooms } = this.context.store.state;
    return (this.cell === null ? undefined : zooms.get(this.cell.group)) ?? kWholePicture;
  }

  private rect(): Rect | null {
    const { area, drawn } = this;
    if (drawn === null || area.width === 0 || area.height === 0) return null;
    return placed(area, { width: drawn.width_px, height: drawn.height_px }, this.zoom);
  }

  private draw(picture: Picture | null): void {
    if (picture === this.drawn) return;
    this.drawn = picture;
    this.canvas.style.visibility = picture === null ? 'hidden' : 'visible';
    if (picture === null) return;
    const { canvas } = this;
    if (canvas.width !== picture.width_px || canvas.height !== picture.height_px) {
      canvas.width = picture.width_px;
      canvas.height = picture.height_px;
    }
    canvas.getContext('2d', { alpha: false })?.drawImage(picture.bitmap, 0, 0);
  }

  private drawLegend({ legend, picture }: PictureCell): void {
    const scale = picture?.scale ?? null;
    this.legend.hidden = legend === null || scale === null;
    if (legend === null || scale === null) return;
    const ticks = ticksOf(scale);
    rebuild(this.legend, JSON.stringify([legend, scale]), () => [
      h('span', { class: 'legend-label' }, legend.label),
      h('div', { class: 'legend-bar', style: `background:${gradient(legend.of)}` }),
      h(
        'div',
        { class: 'legend-ticks' },
        ...ticks.map(({ value, share }) =>
          h('span', { style: `left:${(share * 100).toFixed(2)}%` }, formatNumber(value, 0)),
        ),
      ),
    ]);
  }

  private setZoom(zoom: Zoom): void {
    const { store } = this.context;
    if (this.cell === null) return;
    store.state.zooms.set(this.cell.group, zoom);
    store.change('zoom');
  }

  private zoomBy(factor: number, at: Point | null): void {
    const { area, drawn } = this;
    if (drawn === null) return;
    const picture = { width: drawn.width_px, height: drawn.height_px };
    const middle = { x: area.width / 2, y: area.height / 2 };
    this.setZoom(zoomedAt(area, picture, this.zoom, at ?? middle, factor));
  }

  private panBy(by: Point): void {
    const { drawn } = this;
    if (drawn === null || this.zoom.scale === 1) return;
    const picture = { width: drawn.width_px, height: drawn.height_px };
    this.setZoom(panned(this.area, picture, this.zoom, by));
  }

  /** Tells where the mouse points, and asks what is there. */
  private point(): void {
    const { cell, pointed, drawn } = this;
    const rect = this.rect();
    if (cell === null || pointed === null || drawn === null || rect === null) return;
    const share = shareAt(rect, pointed);
    const full = { width: drawn.fullWidth_px, height: drawn.fullHeight_px };
    const pixel = pixelAt(share, full);
    const { probe, store } = this.context;
    if (pixel === null) {
      if (store.state.hover !== null) probe.point(null);
      return;
    }
    const { id } = cell.watched;
    const known = store.state.hover;
    const same = known?.run === id && known.x === share.x && known.y === share.y;
    if (!same) probe.point({ run: id, group: cell.group, ...share });
    if (cell.asks === null) {
      probe.askNothing();
      return;
    }
    probe.ask({
      run: id,
      frame: drawn.frame,
      x_px: pixel.x,
      y_px: pixel.y,
      ...cell.asks,
      alignment: shownAlignment(cell.watched),
    });
  }

  private listen(): void {
    const { root, pointers } = this;
    const placeOf = (event: MouseEvent): Point => {
      const { left, top } = root.getBoundingClientRect();
      return { x: event.clientX - left, y: event.clientY - top };
    };
    root.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      pointers.set(event.pointerId, placeOf(event));
      root.setPointerCapture(event.pointerId);
    });
    root.addEventListener('pointermove', (event) => {
      const at = placeOf(event);
      this.pointed = at;
      const before = pointers.get(event.pointerId);
      if (before !== undefined) {
        this.drag(event.pointerId, before, at);
        pointers.set(event.pointerId, at);
      }
      this.point();
    });
    const release = (event: PointerEvent) => pointers.delete(event.pointerId);
    root.addEventListener('pointerup', release);
    root.addEventListener('pointercancel', release);
    root.addEventListener('pointerleave', () => this.leave());
    // After a click the keys of the screen go on working.
    root.addEventListener('click', () => root.blur());
    root.addEventListener('dblclick', () => this.setZoom(kWholePicture));
    root.addEventListener(
      'wheel',
      (event) => {
        event.preventDefault();
        this.zoomBy(Math.exp(-event.deltaY * kZoomPerPixel), placeOf(event));
      },
      { passive: false },
    );
    root.addEventListener('keydown', (event) => this.onKey(event));
  }

  /** One finger or the mouse moves the picture, two fingers zoom it. */
  private drag(id: number, before: Point, at: Point): void {
    const other = [...this.pointers].find(([pointer]) => pointer !== id)?.[1];
    if (other === undefined) {
      this.panBy({ x: at.x - before.x, y: at.y - before.y });
      return;
    }
    const apart = (p: Point) => Math.max(1, Math.hypot(p.x - other.x, p.y - other.y));
    const middle = { x: (at.x + other.x) / 2, y: (at.y + other.y) / 2 };
    this.zoomBy(apart(at) / apart(before), middle);
  }

  /** Keys of a picture that has the focus; the rest of the screen does not get them. */
  private onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { width, height } = this.area;
    const moves: Record<string, () => void> = {
      '+': () => this.zoomBy(kKeyZoom, null),
      '=': () => this.zoomBy(kKeyZoom, null),
      '-': () => this.zoomBy(1 / kKeyZoom, null),
      '0': () => this.setZoom(kWholePicture),
      ArrowLeft: () => this.panBy({ x: kKeyPan * width, y: 0 }),
      ArrowRight: () => this.panBy({ x: -kKeyPan * width, y: 0 }),
      ArrowUp: () => this.panBy({ x: 0, y: kKeyPan * height }),
      ArrowDown: () => this.panBy({ x: 0, y: -kKeyPan * height }),
    };
    const move = moves[event.key];
    if (move === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    move();
  }
}
