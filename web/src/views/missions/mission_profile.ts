// What a mission is like along its way: heights over the terrain, bank, motion of the image,
// overlap, texels. One axis, one cursor.
import type { MissionSamples } from '../../protocol/mission_types';
import { formatDuration, formatNumber } from '../../store/format';
import { ticks, tickText } from '../../store/plots/path_frame';
import { valueTicks } from '../../store/plots/value_ticks';
import type { MissionLimits, MissionReport } from '../../protocol/mission_types';
import type { MissionPage } from '../../store/missions/mission_page';
import { h, setText } from '../dom';
import { paint } from '../paint';
import { cursorSample } from './map_paths';
import type { Strip } from './profile_strips';
import { kStrips, stripRange } from './profile_strips';

const kLeft_px = 52;
const kRight_px = 10;
/** Between the numbers of the distance. */
const kDistances_px = 60;
const kTop_px = 4;
const kBottom_px = 22;
const kGap_px = 4;
/** Of the label above each strip. */
const kLabel_px = 13;
/** The heights take as much room as this many of the other strips. */
const kHeightShare = 2;

export class MissionProfile {
  readonly root: HTMLElement;
  private readonly canvas = h('canvas', {
    class: 'mission-profile-canvas',
    role: 'img',
    'aria-label': 'Heights, bank, image motion, overlap and texels along the mission',
  });
  private readonly readout = h('div', { class: 'mission-readout', 'data-role': 'profile-readout' });
  private report: MissionReport | null = null;
  private limits: MissionLimits | null = null;
  private cursor_m: number | null = null;

  constructor(onCursor: (distance_m: number | null) => void) {
    this.root = h(
      'section',
      { class: 'mission-profile', 'data-role': 'mission-profile' },
      this.readout,
      this.canvas,
    );
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    this.canvas.addEventListener('pointermove', ({ offsetX }) => {
      const length = this.length();
      if (length <= 0) return;
      const share = (offsetX - kLeft_px) / Math.max(1, this.width());
      onCursor(Math.max(0, Math.min(1, share)) * length);
    });
    this.canvas.addEventListener('pointerleave', () => onCursor(null));
  }

  show({ report, limits, cursor_m }: MissionPage): void {
    if (this.report === report && this.limits === limits && this.cursor_m === cursor_m) return;
    this.report = report;
    this.limits = limits;
    this.cursor_m = cursor_m;
    this.draw();
  }

  repaint(): void {
    this.draw();
  }

  private length(): number {
    return this.report?.distance_m ?? 0;
  }

  private width(): number {
    return this.canvas.clientWidth - kLeft_px - kRight_px;
  }

  private draw(): void {
    const { clientWidth, clientHeight } = this.canvas;
    const pen = this.canvas.getContext('2d');
    if (pen === null || clientWidth < 80 || clientHeight < 40) return;
    const ratio = window.devicePixelRatio;
    this.canvas.width = Math.round(clientWidth * ratio);
    this.canvas.height = Math.round(clientHeight * ratio);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, clientWidth, clientHeight);
    const { report, limits } = this;
    this.drawReadout();
    if (report === null || limits === null) return;
    const between = (kGap_px + kLabel_px) * kStrips.length;
    const usable = clientHeight - kTop_px - kBottom_px - between;
    const unit = usable / (kStrips.length - 1 + kHeightShare);
    let top = kTop_px;
    kStrips.forEach((strip, i) => {
      const height = unit * (i === 0 ? kHeightShare : 1);
      this.drawStrip(pen, strip, report, limits, top + kLabel_px, height);
      top += kLabel_px + height + kGap_px;
    });
    this.drawAxis(pen, clientHeight);
    this.drawCursor(pen, clientHeight);
  }

  private drawStrip(
    pen: CanvasRenderingContext2D,
    strip: Strip,
    report: MissionReport,
    limits: MissionLimits,
    top: number,
    height: number,
  ): void {
    const { samples } = report;
    const [low, high] = stripRange(strip, samples, limits);
    const x = (i: number) => this.xOf(samples.distance_m[i] ?? 0);
    const y = (value: number) => top + height * (1 - (value - low) / (high - low));
    pen.font = '10px system-ui, sans-serif';
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    pen.lineWidth = 1;
    const values = valueTicks(low, high, height);
    for (const tick of values) {
      pen.strokeStyle = paint('var(--grid)');
      line(pen, kLeft_px, y(tick), kLeft_px + this.width(), y(tick));
      pen.fillStyle = paint('var(--muted)');
      const step = (values[1] ?? 1) - (values[0] ?? 0);
      pen.fillText(tickText(tick, step), kLeft_px - 5, y(tick));
    }
    const limit = strip.limit?.(limits);
    const limitShown = limit !== undefined && limit > low && limit < high;
    if (limitShown) {
      pen.strokeStyle = paint('var(--limit)');
      pen.setLineDash([4, 4]);
      line(pen, kLeft_px, y(limit), kLeft_px + this.width(), y(limit));
      pen.setLineDash([]);
    }
    if (strip.ground === true) this.drawGround(pen, samples, x, y, top + height);
    pen.save();
    pen.beginPath();
    pen.rect(kLeft_px, top, this.width(), height);
    pen.clip();
    for (const curve of strip.curves) {
      pen.strokeStyle = paint(curve.colour);
      pen.lineWidth = 1.5;
      path(pen, curve.values(samples), x, y);
    }
    pen.restore();
    if (limitShown) {
      pen.textAlign = 'right';
      const below = y(limit) - top < kLabel_px;
      pen.textBaseline = below ? 'top' : 'bottom';
      pen.fillStyle = paint('var(--muted)');
      pen.fillText(`limit ${limit}`, kLeft_px + this.width(), y(limit) + (below ? 2 : -1));
    }
    pen.textAlign = 'left';
    pen.textBaseline = 'bottom';
    pen.fillStyle = paint('var(--text)');
    pen.fillText(strip.label, kLeft_px, top - 1);
  }

  private drawGround(
    pen: CanvasRenderingContext2D,
    samples: MissionSamples,
    x: (i: number) => number,
    y: (value: number) => number,
    bottom: number,
  ): void {
    const { ground_ellipsoid_m } = samples;
    pen.beginPath();
    pen.moveTo(x(0), bottom);
    ground_ellipsoid_m.forEach((ground, i) => pen.lineTo(x(i), y(ground)));
    pen.lineTo(x(ground_ellipsoid_m.length - 1), bottom);
    pen.closePath();
    pen.fillStyle = paint('color-mix(in srgb, var(--neutral-2) 35%, transparent)');
    pen.fill();
    pen.strokeStyle = paint('var(--neutral-2)');
    pen.lineWidth = 1.5;
    path(pen, ground_ellipsoid_m, x, y);
  }

  private xOf(distance_m: number): number {
    return kLeft_px + (this.width() * distance_m) / Math.max(1, this.length());
  }

  private drawAxis(pen: CanvasRenderingContext2D, height: number): void {
    pen.font = '10px system-ui, sans-serif';
    pen.textBaseline = 'bottom';
    pen.fillStyle = paint('var(--muted)');
    const length = this.length();
    const kilometres = length >= 2000;
    for (const tick of ticks(0, length, this.width() / kDistances_px)) {
      pen.textAlign = tick === 0 ? 'left' : 'center';
      const x = this.xOf(tick);
      if (x > kLeft_px + this.width() - 24) continue;
      pen.fillText(
        kilometres ? formatNumber(tick / 1000, 1) : formatNumber(tick, 0),
        x,
        height - 4,
      );
    }
    pen.textAlign = 'right';
    pen.fillText(kilometres ? 'km' : 'm', kLeft_px + this.width(), height - 4);
  }

  private drawCursor(pen: CanvasRenderingContext2D, height: number): void {
    if (this.cursor_m === null) return;
    pen.strokeStyle = paint('var(--cursor)');
    pen.lineWidth = 1;
    line(pen, this.xOf(this.cursor_m), kTop_px, this.xOf(this.cursor_m), height - kBottom_px);
  }

  private drawReadout(): void {
    const { report, cursor_m } = this;
    if (report === null) {
      setText(this.readout, '');
      return;
    }
    const at = cursor_m === null ? null : cursorSample(report.samples, cursor_m);
    setText(this.readout, at === null ? summary(report) : readoutText(report.samples, at));
  }
}

const kEnds: Readonly<Record<MissionReport['end'], string>> = {
  done: '',
  landed: ', ends with the landing',
  hit_ground: ', HITS THE GROUND',
  time_limit: ', does not end',
};

/** What a mission is like as a whole. */
export function summary({ duration_s, distance_m, end, start }: MissionReport): string {
  const begin =
    start === null || !start.enough
      ? ''
      : ` · straight and level from ${formatNumber(start.from_s, 0)} s, ${formatNumber(start.length_m, 0)} m long`;
  const length = `${formatNumber(distance_m / 1000, 2)} km`;
  return `${length}, ${formatDuration(duration_s)}${kEnds[end]}${begin}`;
}

function readoutText(samples: MissionSamples, i: number): string {
  const value = (column: (number | null)[], digits: number) => {
    const number = column[i] ?? null;
    return number === null ? '–' : formatNumber(number, digits);
  };
  return [
    `${value(samples.t_s, 1)} s`,
    samples.phase[i] ?? '',
    `${value(samples.height_agl_m, 0)} m above ground`,
    `${value(samples.ground_speed_m_s, 1)} m/s`,
    `climb ${value(samples.climb_m_s, 1)} m/s`,
    `bank ${value(samples.roll_deg, 0)}°`,
    `motion ${value(samples.translation_px, 1)} + ${value(samples.rotation_px, 1)} px`,
    `overlap ${value(samples.overlap, 2)}`,
    `${value(samples.texels_px, 2)} texels/px`,
  ].join(' · ');
}

function line(pen: CanvasRenderingContext2D, x0: number, y0: number, x1: number, y1: number): void {
  pen.beginPath();
  pen.moveTo(x0, y0);
  pen.lineTo(x1, y1);
  pen.stroke();
}

/** Interrupted where there is no value. */
function path(
  pen: CanvasRenderingContext2D,
  values: readonly (number | null)[],
  x: (i: number) => number,
  y: (value: number) => number,
): void {
  pen.beginPath();
  let drawing = false;
  values.forEach((value, i) => {
    if (value === null) drawing = false;
    else if (drawing) pen.lineTo(x(i), y(value));
    else {
      pen.moveTo(x(i), y(value));
      drawing = true;
    }
  });
  pen.stroke();
}
