// A pen that draws into an SVG file what painters draw on a canvas.

type Canvas = CanvasRenderingContext2D;

/** What painters need of a canvas. */
export interface Pen {
  strokeStyle: Canvas['strokeStyle'];
  fillStyle: Canvas['fillStyle'];
  lineWidth: number;
  lineJoin: CanvasLineJoin;
  font: string;
  textAlign: CanvasTextAlign;
  textBaseline: CanvasTextBaseline;
  beginPath(): void;
  closePath(): void;
  moveTo(x: number, y: number): void;
  lineTo(x: number, y: number): void;
  arc(x: number, y: number, radius: number, from: number, to: number): void;
  setLineDash(dash: number[]): void;
  stroke(): void;
  fill(): void;
  fillRect(x: number, y: number, width: number, height: number): void;
  fillText(text: string, x: number, y: number): void;
  measureText(text: string): { width: number };
}

/** Mean width of a letter of a usual font, in heights of the font. */
const kLetter = 0.56;
const kAnchors: Readonly<Record<CanvasTextAlign, string>> = {
  left: 'start',
  start: 'start',
  center: 'middle',
  right: 'end',
  end: 'end',
};
/** Baseline below the given place, in heights of the font. */
const kBelow: Readonly<Record<CanvasTextBaseline, number>> = {
  top: 0.8,
  hanging: 0.8,
  middle: 0.35,
  alphabetic: 0,
  ideographic: -0.15,
  bottom: -0.2,
};

/** Colours are texts; circles are whole ones. */
export class SvgPen implements Pen {
  strokeStyle: Canvas['strokeStyle'] = '#000';
  fillStyle: Canvas['fillStyle'] = '#000';
  lineWidth = 1;
  lineJoin: CanvasLineJoin = 'miter';
  font = '10px sans-serif';
  textAlign: CanvasTextAlign = 'start';
  textBaseline: CanvasTextBaseline = 'alphabetic';
  private readonly parts: string[] = [];
  private path: string[] = [];
  private dash: number[] = [];

  /** The elements drawn so far. */
  get content(): string {
    return this.parts.join('');
  }

  beginPath(): void {
    this.path = [];
  }

  closePath(): void {
    this.path.push('Z');
  }

  moveTo(x: number, y: number): void {
    this.path.push(`M${short(x)} ${short(y)}`);
  }

  lineTo(x: number, y: number): void {
    this.path.push(`${this.path.length === 0 ? 'M' : 'L'}${short(x)} ${short(y)}`);
  }

  arc(x: number, y: number, radius: number): void {
    const r = short(radius);
    const half = (dx: number) => `a${r} ${r} 0 1 0 ${short(dx)} 0`;
    this.path.push(`M${short(x - radius)} ${short(y)}${half(2 * radius)}${half(-2 * radius)}Z`);
  }

  setLineDash(dash: number[]): void {
    this.dash = dash;
  }

  stroke(): void {
    if (this.path.length === 0) return;
    const dash = this.dash.length === 0 ? '' : ` stroke-dasharray="${this.dash.join(' ')}"`;
    this.parts.push(
      `<path d="${this.path.join('')}" fill="none" stroke="${colour(this.strokeStyle)}" ` +
        `stroke-width="${this.lineWidth}" stroke-linejoin="${this.lineJoin}"${dash}/>`,
    );
  }

  fill(): void {
    if (this.path.length === 0) return;
    this.parts.push(`<path d="${this.path.join('')}" fill="${colour(this.fillStyle)}"/>`);
  }

  fillRect(x: number, y: number, width: number, height: number): void {
    this.parts.push(
      `<rect x="${short(x)}" y="${short(y)}" width="${short(width)}" height="${short(height)}" ` +
        `fill="${colour(this.fillStyle)}"/>`,
    );
  }

  fillText(text: string, x: number, y: number): void {
    const size = this.fontSize();
    const bold = /\b(600|700|bold)\b/.test(this.font) ? ' font-weight="600"' : '';
    this.parts.push(
      `<text x="${short(x)}" y="${short(y + kBelow[this.textBaseline] * size)}" ` +
        `text-anchor="${kAnchors[this.textAlign]}" font-family="system-ui, sans-serif" ` +
        `font-size="${size}"${bold} fill="${colour(this.fillStyle)}">${escaped(text)}</text>`,
    );
  }

  /** About. */
  measureText(text: string): { width: number } {
    return { width: kLetter * this.fontSize() * text.length };
  }

  private fontSize(): number {
    return Number(/([\d.]+)px/.exec(this.font)?.[1] ?? 10);
  }
}

/** A complete file. */
export function svgFile(
  width: number,
  height: number,
  background: string,
  content: string,
): string {
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" ` +
    `viewBox="0 0 ${width} ${height}">` +
    `<rect width="${width}" height="${height}" fill="${background}"/>${content}</svg>\n`
  );
}

/** Drawn with its upper left corner at a place; what lies outside its size is cut off. */
export function clipped(
  x: number,
  y: number,
  width: number,
  height: number,
  content: string,
): string {
  return `<svg x="${x}" y="${y}" width="${width}" height="${height}">${content}</svg>`;
}

export function escaped(text: string): string {
  return text.replace(/[&<>"]/g, (found) => `&#${found.charCodeAt(0)};`);
}

function colour(style: Canvas['strokeStyle']): string {
  return typeof style === 'string' ? style : '#000';
}

function short(value: number): string {
  return String(Number(value.toFixed(2)));
}
