// Rates of the picture streams: as measured, and as limited by a real-time flight or the connection.
import { picturesOf } from '../../connection/stream_client';
import type { PictureInfo } from '../../protocol/messages';
import type { PictureEncoding } from '../../protocol/parse';
import { formatNumber } from '../format';

export interface PictureRate {
  now_hz: number;
  asked_hz: number;
}

/** The pictures whose rate a real-time flight limits below the requested one, by name. */
export function pictureRates(pictures: readonly PictureInfo[]): Map<string, PictureRate> {
  const rates = new Map<string, PictureRate>();
  for (const { name, camera, view, max_hz, limit_hz } of pictures) {
    if (max_hz === undefined || limit_hz === undefined || limit_hz >= max_hz) continue;
    rates.set(picturesOf(name, camera, view), { now_hz: limit_hz, asked_hz: max_hz });
  }
  return rates;
}

/** What arrived of a stream in the last seconds. */
export interface MeasuredRate {
  hz: number;
  bytes_per_s: number;
  encoding: PictureEncoding;
}

const kSpan_ms = 2000;

/** Counts what arrives. */
export class PictureMeter {
  private readonly arrivals = new Map<
    string,
    { at_ms: number; bytes: number; encoding: PictureEncoding }[]
  >();

  count(name: string, bytes: number, encoding: PictureEncoding, now_ms: number): void {
    const list = this.arrivals.get(name) ?? [];
    list.push({ at_ms: now_ms, bytes, encoding });
    while ((list[0]?.at_ms ?? now_ms) < now_ms - kSpan_ms) list.shift();
    this.arrivals.set(name, list);
  }

  /** null if nothing arrives. */
  rate(name: string, now_ms: number): MeasuredRate | null {
    const list = (this.arrivals.get(name) ?? []).filter(({ at_ms }) => at_ms >= now_ms - kSpan_ms);
    const [first, last] = [list[0], list.at(-1)];
    if (first === undefined || last === undefined || list.length < 2) return null;
    const span_s = Math.max(last.at_ms - first.at_ms, 1) / 1000;
    const bytes = list.slice(1).reduce((sum, arrival) => sum + arrival.bytes, 0);
    return {
      hz: (list.length - 1) / span_s,
      bytes_per_s: bytes / span_s,
      encoding: last.encoding,
    };
  }
}

export interface RateBadge {
  text: string;
  hint: string;
  /** Less arrives than was asked for. */
  reduced: boolean;
}

export const kNoRate: RateBadge = { text: '', hint: '', reduced: false };

/**
 * What is told about a stream's rate while its pictures move.
 * @param reduction  steps by which the server reduces pictures for this connection
 */
export function rateBadge(
  measured: MeasuredRate | null,
  limit: PictureRate | undefined,
  reduction: number,
): RateBadge {
  if (limit !== undefined) {
    return {
      text: `${limit.now_hz}/${limit.asked_hz} Hz`,
      hint: 'Pictures per second, actual / requested: the real-time flight has priority',
      reduced: true,
    };
  }
  if (measured === null) return kNoRate;
  const rate = `${formatNumber(measured.hz, measured.hz < 9.95 ? 1 : 0)} Hz`;
  const mbit = formatNumber((measured.bytes_per_s * 8) / 1e6, 1);
  const coding = measured.encoding === 'vp8' ? 'VP8 video' : 'JPEG';
  const hint = `Measured: ${rate}, ${mbit} Mbit/s as ${coding}`;
  if (reduction === 0) return { text: rate, hint, reduced: false };
  return {
    text: `${rate} ▾${reduction}`,
    hint: `${hint}. The connection or this browser is too slow: quality and size are reduced (step ${reduction} of 4)`,
    reduced: true,
  };
}
