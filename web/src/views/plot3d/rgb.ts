// Colours of a style sheet as numbers for WebGL.

/** From 0 to 1, in sRGB. */
export type Rgb = readonly [number, number, number];

/** @param css  as paint() returns it, for example "rgb(240, 90, 82)" */
export function rgbOf(css: string): Rgb {
  const [r = 0, g = 0, b = 0] = (css.match(/[\d.]+/g) ?? []).map(Number);
  return [r / 255, g / 255, b / 255];
}
