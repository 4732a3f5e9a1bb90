// A map of a log's positions: outlines of worlds, scale bar, north, coordinates.
import type { Track } from '../../store/logs/log_track';
import type { Outline } from '../../store/logs/log_worlds';
import { nearestRow, placeText, scaleBar_m } from '../../store/logs/log_track';
import { h, setAttribute, setText } from '../dom';
import { paint } from '../paint';

const kMargin_px = 34;
const kGrid = 'var(--grid)';
const kLine = 'var(--truth)';
const kLineOutside = 'color-mix(in srgb, var(--truth) 30%, transparent)';
const kText = 'var(--muted)';
const kBar_px = 130;
const kWorld = 'var(--outline)';
const kChosenWorld = 'var(--accent)';

export class LogMap {
  readonly root: HTMLElement;
  private readonly canvas = h('canvas', { class: 'log-track' });
  private readonly place = h('span', { class: 'log-place', 'data-role': 'log-place' });
  private readonly note = h('span', { class: 'log-map-note', 'data-role': 'log-map-note' });
  private track: Track | null = null;
  private outlines: readonly Outline[] = [];
  private slice: readonly [number, number] | null = null;
  private cursor_s: number | null = null;
  /** Metres per pixel, and the place in the middle. */
  private scale = 1;
  private middle: readonly [number, number] = [0, 0];

  constructor(onHover: (t_s: number | null) => void) {
    this.root = h(
      'div',
      { class: 'log-map', 'data-panel': 'log-map' },
      this.canvas,
      this.place,
      this.note,
    );
    new ResizeObserver(() => this.fit()).observe(this.root);
    this.canvas.addEventListener('pointermove', (event) => this.hover(event, onHover));
    this.canvas.addEventListener('pointerleave', () => {
      onHover(null);
      setText(this.place, '');
    });
  }

  /** @param note  about the place of the flight */
  show(track: Track | null, outlines: readonly Outline[], note: string): void {
    setText(this.note, note);
    if (track === this.track && outlines === this.outlines) return;
    this.track = track;
    this.outlines = outlines;
    setAttribute(this.root, 'data-worlds', String(outlines.length));
    this.fit();
    // The place under a mouse at rest is another one on another track.
    const [first, last] = [track?.t_s[0] ?? Infinity, track?.t_s.at(-1) ?? -Infinity];
    const { cursor_s } = this;
    this.moveCursor(cursor_s !== null && cursor_s >= first && cursor_s <= last ? cursor_s : null);
    if (this.cursor_s === null) setText(this.place, '');
  }

  showSlice(slice: readonly [number, number] | null): void {
    this.slice = slice;
    this.draw();
  }

  moveCursor(t_s: number | null): void {
    this.cursor_s = t_s;
    this.draw();
    if (this.track === null || t_s === null) return;
    const row = nearestRow(this.track.t_s, t_s);
    if (row >= 0) {
      setText(
        this.place,
        placeText(this.track, this.track.east_m[row] ?? 0, this.track.north_m[row] ?? 0),
      );
    }
  }

  private hover(event: PointerEvent, onHover: (t_s: number | null) => void): void {
    const { track } = this;
    if (track === null) return;
    const [east, north] = this.metresAt(event.offsetX, event.offsetY);
    let best = -1;
    let least = Infinity;
    track.east_m.forEach((e, i) => {
      const distance = Math.hypot(e - east, (track.north_m[i] ?? 0) - north);
      if (distance < least) {
        least = distance;
        best = i;
      }
    });
    const near = best >= 0 && least < 12 * this.scale;
    onHover(near ? (track.t_s[best] ?? null) : null);
    if (!near) setText(this.place, placeText(track, east, north));
  }

  private metresAt(x_px: number, y_px: number): [number, number] {
    const { clientWidth, clientHeight } = this.root;
    return [
      this.middle[0] + (x_px - clientWidth / 2) * this.scale,
      this.middle[1] - (y_px - clientHeight / 2) * this.scale,
    ];
  }

  private pixelOf(east_m: number, north_m: number): [number, number] {
    const { clientWidth, clientHeight } = this.root;
    return [
      clientWidth / 2 + (east_m - this.middle[0]) / this.scale,
      clientHeight / 2 - (north_m - this.middle[1]) / this.scale,
    ];
  }

  private fit(): void {
    const { clientWidth, clientHeight } = this.root;
    if (clientWidth < 40 || clientHeight < 40) return;
    this.canvas.width = Math.round(clientWidth * window.devicePixelRatio);
    this.canvas.height = Math.round(clientHeight * window.devicePixelRatio);
    if (this.track !== null && this.track.t_s.length > 0) {
      const range = (values: number[]) =>
        values.reduce<[number, number]>(
          ([low, high], v) => [Math.min(low, v), Math.max(high, v)],
          [Infinity, -Infinity],
        );
      // The chosen world if the flight is in or near it, not one on another continent.
      const [own_m, span_m] = [range(this.track.east_m), range(this.track.north_m)];
      const near = this.outlines.find(
        ({ chosen, east_m, north_m }) =>
          chosen && touches(own_m, range(east_m)) && touches(span_m, range(north_m)),
      );
      const [west, east] = range([...this.track.east_m, ...(near?.east_m ?? [])]);
      const [south, north] = range([...this.track.north_m, ...(near?.north_m ?? [])]);
      this.middle = [(west + east) / 2, (south + north) / 2];
      this.scale = Math.max(
        (east - west) / Math.max(20, clientWidth - 2 * kMargin_px),
        (north - south) / Math.max(20, clientHeight - 2 * kMargin_px),
        0.02,
      );
    }
    this.draw();
  }

  repaint(): void {
    this.draw();
  }

  private draw(): void {
    const pen = this.canvas.getContext('2d');
    if (pen === null) return;
    const ratio = window.devicePixelRatio;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, this.root.clientWidth, this.root.clientHeight);
    if (this.track === null || this.track.t_s.length === 0) return;
    const bar_m = scaleBar_m(kBar_px * this.scale);
    this.drawGrid(pen, bar_m);
    for (const outline of this.outlines) this.drawOutline(pen, outline);
    this.drawTrack(pen, this.track);
    this.drawFurniture(pen, bar_m);
  }

  private drawOutline(
    pen: CanvasRenderingContext2D,
    { name, east_m, north_m, chosen }: Outline,
  ): void {
    pen.strokeStyle = paint(chosen ? kChosenWorld : kWorld);
    pen.lineWidth = chosen ? 1.5 : 1;
    pen.setLineDash(chosen ? [] : [5, 4]);
    pen.beginPath();
    let [left, top, right, bottom] = [Infinity, Infinity, -Infinity, -Infinity];
    east_m.forEach((east, i) => {
      const [x, y] = this.pixelOf(east, north_m[i] ?? 0);
      if (i === 0) pen.moveTo(x, y);
      else pen.lineTo(x, y);
      [left, right] = [Math.min(left, x), Math.max(right, x)];
      [top, bottom] = [Math.min(top, y), Math.max(bottom, y)];
    });
    const { clientWidth, clientHeight } = this.root;
    if (!touches([left, right], [0, clientWidth]) || !touches([top, bottom], [0, clientHeight])) {
      pen.setLineDash([]);
      return;
    }
    pen.closePath();
    pen.stroke();
    pen.setLineDash([]);
    pen.font = '10px system-ui, sans-serif';
    pen.textAlign = 'left';
    pen.fillStyle = paint(chosen ? kChosenWorld : kText);
    pen.fillText(name, Math.max(left + 5, 6), Math.max(top + 13, 34));
  }

  private drawGrid(pen: CanvasRenderingContext2D, step_m: number): void {
    const { clientWidth, clientHeight } = this.root;
    const [west, north] = this.metresAt(0, 0);
    const [east, south] = this.metresAt(clientWidth, clientHeight);
    pen.strokeStyle = paint(kGrid);
    pen.lineWidth = 1;
    pen.beginPath();
    for (let e = Math.ceil(west / step_m) * step_m; e <= east; e += step_m) {
      const [x] = this.pixelOf(e, 0);
      pen.moveTo(x, 0);
      pen.lineTo(x, clientHeight);
    }
    for (let n = Math.ceil(south / step_m) * step_m; n <= north; n += step_m) {
      const [, y] = this.pixelOf(0, n);
      pen.moveTo(0, y);
      pen.lineTo(clientWidth, y);
    }
    pen.stroke();
  }

  private drawTrack(pen: CanvasRenderingContext2D, track: Track): void {
    const inside = (t_s: number) =>
      this.slice === null || (t_s >= this.slice[0] && t_s <= this.slice[1]);
    pen.lineJoin = 'round';
    for (const flown of [false, true]) {
      pen.strokeStyle = paint(flown ? kLine : kLineOutside);
      pen.lineWidth = flown ? 2 : 1.5;
      pen.beginPath();
      let drawing = false;
      track.t_s.forEach((t_s, i) => {
        const [x, y] = this.pixelOf(track.east_m[i] ?? 0, track.north_m[i] ?? 0);
        if (drawing) pen.lineTo(x, y);
        drawing = inside(t_s) === flown;
        if (drawing) pen.moveTo(x, y);
      });
      pen.stroke();
    }
    const first = track.t_s.findIndex(inside);
    if (first >= 0) this.dot(pen, track, first, 'var(--good)', 'start');
    if (this.cursor_s !== null) {
      this.dot(pen, track, nearestRow(track.t_s, this.cursor_s), 'var(--cursor)', '');
    }
  }

  private dot(
    pen: CanvasRenderingContext2D,
    track: Track,
    row: number,
    colour: string,
    label: string,
  ): void {
    const [x, y] = this.pixelOf(track.east_m[row] ?? 0, track.north_m[row] ?? 0);
    pen.fillStyle = paint(colour);
    pen.beginPath();
    pen.arc(x, y, 4, 0, 2 * Math.PI);
    pen.fill();
    if (label === '') return;
    pen.font = '10px system-ui, sans-serif';
    pen.fillStyle = paint(kText);
    pen.textAlign = 'left';
    pen.fillText(label, x + 7, y - 5);
  }

  /** Scale bar and arrow to the north. */
  private drawFurniture(pen: CanvasRenderingContext2D, bar_m: number): void {
    const { clientWidth, clientHeight } = this.root;
    const length_px = bar_m / this.scale;
    const [x, y] = [12, clientHeight - 12];
    pen.strokeStyle = paint(kText);
    pen.fillStyle = paint(kText);
    pen.lineWidth = 1.5;
    pen.font = '11px system-ui, sans-serif';
    pen.beginPath();
    pen.moveTo(x, y - 5);
    pen.lineTo(x, y);
    pen.lineTo(x + length_px, y);
    pen.lineTo(x + length_px, y - 5);
    pen.stroke();
    pen.textAlign = 'left';
    pen.fillText(bar_m >= 1000 ? `${bar_m / 1000} km` : `${bar_m} m`, x + 6, y - 5);
    const [nx, ny] = [clientWidth - 20, 30];
    pen.beginPath();
    pen.moveTo(nx, ny - 14);
    pen.lineTo(nx - 5, ny);
    pen.lineTo(nx + 5, ny);
    pen.closePath();
    pen.fill();
    pen.textAlign = 'center';
    pen.fillText('N', nx, ny + 12);
  }
}

/** Whether two ranges overlap. */
function touches(a: readonly [number, number], b: readonly [number, number]): boolean {
  return a[0] <= b[1] && b[0] <= a[1];
}
