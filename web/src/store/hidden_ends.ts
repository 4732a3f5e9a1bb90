// What of a row that scrolls sideways is out of sight.

export interface ScrolledRow {
  scrollLeft: number;
  clientWidth: number;
  scrollWidth: number;
}

/** Browsers round these sizes. */
const kRounding_px = 1;

/** Whether there is more before and behind what is seen. */
export function hiddenEnds({ scrollLeft, clientWidth, scrollWidth }: ScrolledRow): {
  left: boolean;
  right: boolean;
} {
  return {
    left: scrollLeft > kRounding_px,
    right: scrollLeft + clientWidth < scrollWidth - kRounding_px,
  };
}
