// The colours of depth and error pictures, and the legend that explains them. The server paints
// with the same colours (server/views/images/colour_map.cpp).

export interface ColourScale {
  low: number;
  high: number;
  logarithmic: boolean;
}

type Rgb = readonly [number, number, number];

/** From far to near. */
const kDepthColours: readonly Rgb[] = [
  [41, 19, 91],
  [26, 50, 130],
  [0, 86, 157],
  [0, 123, 166],
  [0, 157, 159],
  [0, 184, 143],
  [115, 205, 129],
  [192, 221, 132],
  [250, 237, 161],
];
/** From negative to positive. */
const kErrorColours: readonly Rgb[] = [
  [128, 195, 255],
  [80, 146, 212],
  [49, 99, 149],
  [35, 56, 79],
  [18, 18, 18],
  [76, 47, 21],
  [142, 78, 0],
  [204, 117, 24],
  [255, 166, 85],
];

/** A CSS gradient from the low to the high end of a scale. */
export function gradient(of: 'depth' | 'error'): string {
  const colours = of === 'depth' ? [...kDepthColours].reverse() : kErrorColours;
  return `linear-gradient(to right, ${colours.map((rgb) => `rgb(${rgb.join(' ')})`).join(', ')})`;
}

export interface Tick {
  value: number;
  /** Along the scale, in [0, 1]. */
  share: number;
}

/** A few round values of a scale. */
export function ticksOf(scale: ColourScale, most = 5): Tick[] {
  const { low, high, logarithmic } = scale;
  if (!(high > low)) return [];
  const values = logarithmic ? logarithmicValues(low, high, most) : linearValues(low, high, most);
  const place = (value: number) => (logarithmic ? Math.log(value) : value);
  const span = place(high) - place(low);
  return values.map((value) => ({ value, share: (place(value) - place(low)) / span }));
}

function linearValues(low: number, high: number, most: number): number[] {
  const step = roundStep((high - low) / Math.max(1, most - 1));
  const values: number[] = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) {
    values.push(i * step);
  }
  return values;
}

/** At least `value`: 1, 2 or 5 times a power of ten. */
function roundStep(value: number): number {
  const decade = 10 ** Math.floor(Math.log10(value));
  const step = [1, 2, 5, 10].find((multiple) => multiple * decade >= value * (1 - 1e-9));
  return (step ?? 10) * decade;
}

function logarithmicValues(low: number, high: number, most: number): number[] {
  const values: number[] = [];
  for (let decade = 10 ** Math.floor(Math.log10(low)); decade <= high; decade *= 10) {
    for (const multiple of [1, 2, 5]) {
      const value = multiple * decade;
      if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) values.push(value);
    }
  }
  const every = Math.ceil(values.length / most);
  return values.filter((_, i) => i % every === 0);
}
