// Places the labels of aircraft in a scene so that they do not cover each other.

export interface LabelBox {
  /** What it belongs to, in the picture. */
  x: number;
  y: number;
  width: number;
  height: number;
}

export interface LabelPlace {
  left: number;
  top: number;
}

const kAbove = 26;
const kGap = 2;

/**
 * Each label stands above its place, in the middle; where two would overlap, the later one moves up,
 * or down if there is no room. All stay inside the area.
 */
export function placeLabels(
  boxes: readonly LabelBox[],
  area: { width: number; height: number },
): LabelPlace[] {
  const taken: { left: number; top: number; right: number; bottom: number }[] = [];
  return boxes.map(({ x, y, width, height }) => {
    const left = Math.min(Math.max(0, x - width / 2), Math.max(0, area.width - width));
    const overlaps = (top: number) =>
      taken.some(
        (box) =>
          left < box.right && box.left < left + width && top < box.bottom && box.top < top + height,
      );
    const first = Math.min(Math.max(0, y - kAbove - height), Math.max(0, area.height - height));
    const step = height + kGap;
    const steps = Array.from({ length: boxes.length + 1 }, (_, i) => i * step);
    const tops = [...steps.map((by) => first - by), ...steps.map((by) => first + by)];
    const top = tops.find((at) => at >= 0 && at + height <= area.height && !overlaps(at)) ?? first;
    taken.push({ left, top, right: left + width, bottom: top + height });
    return { left, top };
  });
}
