// How often pictures come while a flight in real time needs the machine.
import { picturesOf } from '../connection/stream_client';
import type { StreamInfo } from '../protocol/messages';

export interface PictureRate {
  now_hz: number;
  asked_hz: number;
}

/** By the name of their pictures: the streams that come more slowly than they were asked for. */
export function pictureRates(streams: readonly StreamInfo[]): Map<string, PictureRate> {
  const rates = new Map<string, PictureRate>();
  for (const { name, camera, max_hz, limit_hz } of streams) {
    if (max_hz === undefined || limit_hz === undefined || limit_hz >= max_hz) continue;
    rates.set(picturesOf(name, camera), { now_hz: limit_hz, asked_hz: max_hz });
  }
  return rates;
}

/** Empty where nothing holds the pictures back. */
export function rateText(rate: PictureRate | undefined): string {
  return rate === undefined ? '' : `${rate.now_hz}/${rate.asked_hz} Hz`;
}
