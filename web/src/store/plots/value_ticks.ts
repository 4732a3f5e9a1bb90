// Where the numbers of a plot's value axis stand.
import { ticks } from './path_frame';

/** From one number to the next. */
const kSpace_px = 20;
/** In a low plot. */
const kLeastSpace_px = 13;
const kFine = 10;

/**
 * Round values of a range. There are two at least, because sizes cannot be read off one: in a plot that is
 * too low for two neighbours, the least and the greatest.
 */
export function valueTicks(low: number, high: number, height_px: number): number[] {
  for (const space_px of [kSpace_px, kLeastSpace_px]) {
    const fitting = ticks(low, high, height_px / space_px);
    if (fitting.length > 1) return fitting;
  }
  const fine = ticks(low, high, kFine);
  const [least] = fine;
  const greatest = fine.at(-1);
  return least === undefined || greatest === undefined ? [] : [least, greatest];
}
