// Delay before the next attempt to connect.

const kFirst_ms = 500;
const kLongest_ms = 8000;

/**
 * Doubles from 0.5 s up to 8 s, minus a random part of up to a quarter, so that viewers do not all
 * reconnect at once.
 */
export function backoffDelay_ms(attempt: number, random: () => number): number {
  const full = Math.min(kLongest_ms, kFirst_ms * 2 ** Math.max(0, attempt - 1));
  return Math.round(full * (1 - 0.25 * random()));
}
