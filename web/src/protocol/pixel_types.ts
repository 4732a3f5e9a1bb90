// What the server says about one pixel of a frame; docs/PROTOCOL.md is the contract.

export interface PixelGround {
  lat_deg: number;
  lon_deg: number;
  alt_ellipsoid_m: number;
  x_m: number;
  y_m: number;
  z_m: number;
}

export interface PixelAnswer {
  frame: number;
  t_ns: number;
  camera: string;
  width_px: number;
  height_px: number;
  /** Of the whole image, as estimators get it. */
  grey: number;
  rgb: [number, number, number] | null;
  /** Of the error picture asked for, in grey levels. */
  difference: number | null;
  /** null = the pixel sees the sky. */
  ground: PixelGround | null;
  depth_m: number | null;
  range_m: number | null;
}

export interface PixelQuestion {
  run: string;
  frame: number;
  x_px: number;
  y_px: number;
  /** null = the first camera */
  camera: string | null;
  /** `camera`, `depth`, `error` or `error/NAME` */
  picture: string;
  alignment: string;
}
