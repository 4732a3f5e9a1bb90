// What the pixel under the mouse shows: asked from the server, because the picture on the screen may
// be reduced and is compressed.
import { errorText } from '../../connection/rest_error';
import type { RestClient } from '../../connection/rest_client';
import type { PixelAnswer, PixelQuestion } from '../../protocol/pixel_types';
import { formatNumber } from '../format';
import type { Store } from '../state';

/** The place at which the mouse points. */
export interface Hover {
  run: string;
  /** Key of the pictures that show the same place. */
  group: string;
  /** In shares of the picture. */
  x: number;
  y: number;
}

/** The mouse moves more often than an answer is worth asking for. */
const kLeastGap_ms = 60;

export class PixelProbe {
  private wanted: PixelQuestion | null = null;
  private asked = '';
  private busy = false;

  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
    private readonly later: (callback: () => void, delay_ms: number) => void,
  ) {}

  /** Where the mouse points, so that every picture of the camera marks the place; null = nowhere. */
  point(hover: Hover | null): void {
    this.store.state.hover = hover;
    if (hover === null) this.forget();
    this.store.change('hover');
  }

  /** The mouse points at a picture that asks nothing: an answer on the way belongs to another one. */
  askNothing(): void {
    if (this.asked === '' && this.wanted === null) return;
    this.forget();
    this.store.change('hover');
  }

  private forget(): void {
    this.wanted = null;
    this.asked = '';
    this.store.state.pixel = null;
  }

  /** The newest question counts; one is answered at a time. */
  ask(question: PixelQuestion): void {
    const key = JSON.stringify(question);
    if (key === this.asked && this.wanted === null) return;
    this.wanted = question;
    if (!this.busy) void this.next();
  }

  private async next(): Promise<void> {
    this.busy = true;
    while (this.wanted !== null) {
      const question = this.wanted;
      this.wanted = null;
      const key = JSON.stringify(question);
      this.asked = key;
      let answer: PixelAnswer | string;
      try {
        answer = await this.rest.pixel(question);
      } catch (error) {
        answer = errorText(error);
      }
      if (this.asked === key) {
        this.store.state.pixel = { question, answer };
        this.store.change('hover');
      }
      await new Promise<void>((done) => this.later(done, kLeastGap_ms));
    }
    this.busy = false;
  }
}

/** The parts of the read-out, of which a narrow panel shows as many as fit. */
export function pixelTexts({ x_px, y_px }: PixelQuestion, answer: PixelAnswer): string[] {
  const texts = [`x ${formatNumber(x_px, 1)}  y ${formatNumber(y_px, 1)} px`];
  const colour = answer.rgb === null ? '' : ` (${answer.rgb.join(' ')})`;
  texts.push(`grey ${answer.grey}${colour}`);
  if (answer.difference !== null) {
    const sign = answer.difference > 0 ? '+' : '';
    texts.push(`difference ${sign}${formatNumber(answer.difference, 0)}`);
  }
  const { ground } = answer;
  if (ground === null) return [...texts, 'sky'];
  const side = (value: number, positive: string, negative: string) =>
    `${formatNumber(Math.abs(value), 6)}° ${value < 0 ? negative : positive}`;
  texts.push(`${side(ground.lat_deg, 'N', 'S')}  ${side(ground.lon_deg, 'E', 'W')}`);
  texts.push(`height ${formatNumber(ground.alt_ellipsoid_m, 1)} m`);
  texts.push(`range ${formatNumber(answer.range_m, 1)} m`);
  return texts;
}
