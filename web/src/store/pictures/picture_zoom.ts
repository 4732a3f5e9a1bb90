// Which part of a picture is shown, and where its pixels are on the screen. Pure geometry.

export interface Size {
  width: number;
  height: number;
}

export interface Point {
  x: number;
  y: number;
}

export interface Rect extends Point, Size {}

/** The magnification, and the place of the picture at the middle of the area, in shares of it. */
export interface Zoom {
  scale: number;
  x: number;
  y: number;
}

export const kWholePicture: Zoom = { scale: 1, x: 0.5, y: 0.5 };
const kLargestScale = 64;

/** Whether numbers from outside make a zoom. */
export function isZoom({ scale, x, y }: Zoom): boolean {
  return scale >= 1 && scale <= kLargestScale && x >= 0 && x <= 1 && y >= 0 && y <= 1;
}

/** Where the whole picture lies on an area, in its units; parts may be outside. */
export function placed(area: Size, picture: Size, zoom: Zoom): Rect {
  const fit = Math.min(area.width / picture.width, area.height / picture.height) * zoom.scale;
  const width = picture.width * fit;
  const height = picture.height * fit;
  return {
    x: area.width / 2 - zoom.x * width,
    y: area.height / 2 - zoom.y * height,
    width,
    height,
  };
}

/** The place of a point of the area in the picture, in shares of it; it may be outside. */
export function shareAt({ x, y, width, height }: Rect, point: Point): Point {
  return { x: (point.x - x) / width, y: (point.y - y) / height };
}

/** Magnifies so that the point of the area keeps showing the same place. */
export function zoomedAt(
  area: Size,
  picture: Size,
  zoom: Zoom,
  point: Point,
  factor: number,
): Zoom {
  const scale = Math.min(kLargestScale, Math.max(1, zoom.scale * factor));
  if (scale === 1) return kWholePicture;
  const share = shareAt(placed(area, picture, zoom), point);
  const { width, height } = placed(area, picture, { ...zoom, scale });
  return kept(area, picture, {
    scale,
    x: share.x + (area.width / 2 - point.x) / width,
    y: share.y + (area.height / 2 - point.y) / height,
  });
}

/** Moves the picture with the mouse. */
export function panned(area: Size, picture: Size, zoom: Zoom, by: Point): Zoom {
  const { width, height } = placed(area, picture, zoom);
  return kept(area, picture, { ...zoom, x: zoom.x - by.x / width, y: zoom.y - by.y / height });
}

/** Keeps the picture from leaving the area: it covers the middle, or is centred where it is small. */
function kept(area: Size, picture: Size, zoom: Zoom): Zoom {
  const { width, height } = placed(area, picture, zoom);
  const within = (value: number, half: number) =>
    half >= 0.5 ? 0.5 : Math.min(1 - half, Math.max(half, value));
  return {
    scale: zoom.scale,
    x: within(zoom.x, area.width / 2 / width),
    y: within(zoom.y, area.height / 2 / height),
  };
}

/** The pixel of the whole image at a share of it; pixel centres are at integers. null = outside */
export function pixelAt(share: Point, full: Size): Point | null {
  if (!(share.x >= 0 && share.x < 1 && share.y >= 0 && share.y < 1)) return null;
  return { x: share.x * full.width - 0.5, y: share.y * full.height - 0.5 };
}

/** The smallest usual width that has a pixel for each pixel of the screen. */
export function widthWanted(area: Size, zoom: Zoom, pixelRatio: number): number {
  const shown_px = area.width * pixelRatio * Math.min(zoom.scale, kLargestScale);
  // Halving a picture of 1280 px gives these; a little blur is better than four times the bytes.
  const step = [320, 640, 1280, 2560].find((width) => shown_px <= width * 1.04);
  return step ?? 8192;
}
