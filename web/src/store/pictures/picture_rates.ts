// Rates of the picture streams while a real-time flight limits them.
import { picturesOf } from '../../connection/stream_client';
import type { PictureInfo } from '../../protocol/messages';

export interface PictureRate {
  now_hz: number;
  asked_hz: number;
}

/** The pictures whose rate is below the requested one, by name. */
export function pictureRates(pictures: readonly PictureInfo[]): Map<string, PictureRate> {
  const rates = new Map<string, PictureRate>();
  for (const { name, camera, max_hz, limit_hz } of pictures) {
    if (max_hz === undefined || limit_hz === undefined || limit_hz >= max_hz) continue;
    rates.set(picturesOf(name, camera), { now_hz: limit_hz, asked_hz: max_hz });
  }
  return rates;
}

/** Empty if the rate is not limited. */
export function rateText(rate: PictureRate | undefined): string {
  return rate === undefined ? '' : `${rate.now_hz}/${rate.asked_hz} Hz`;
}
