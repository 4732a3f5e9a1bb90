// The viewpoint of the 3D plot: it shows all tracks, also while they grow, until the viewer moves it.
import type { AxisScales, Box3 } from '../../store/plot3d/axis_box';
import { axisScales, boxOfScales } from '../../store/plot3d/axis_box';
import type { OrbitView, ScreenMap } from '../../store/plot3d/orbit_view';
import { fittedTo, panned, rotated, screenMap, zoomedAbout } from '../../store/plot3d/orbit_view';
import type { Size } from '../../store/plots/path_frame';

export type Direction = 'oblique' | 'top' | 'side';

/** From the south-south-east; from above with north up; from the south. */
const kDirections: Readonly<Record<Direction, Pick<OrbitView, 'azimuth_rad' | 'elevation_rad'>>> = {
  oblique: { azimuth_rad: -0.5, elevation_rad: 0.5 },
  top: { azimuth_rad: 0, elevation_rad: Math.PI / 2 },
  side: { azimuth_rad: 0, elevation_rad: 0 },
};

export class Plot3dView {
  scales: AxisScales;
  heightScale = 1;
  private size: Size = { width_px: 1, height_px: 1 };
  private orbit: OrbitView = { target: [0, 0, 0], m_per_px: 1, ...kDirections.oblique };
  private fits = true;

  /** @param onChange  called when the viewer has changed it */
  constructor(
    private box: Box3,
    private readonly onChange: () => void,
  ) {
    this.scales = axisScales(box, 1);
  }

  /** Around all tracks. @return whether the axes have changed */
  setBox(box: Box3): boolean {
    const before = JSON.stringify(this.scales);
    this.box = box;
    this.scales = axisScales(box, this.heightScale);
    this.refit();
    return JSON.stringify(this.scales) !== before;
  }

  setSize(size: Size): void {
    this.size = size;
    this.refit();
  }

  /** Heights are drawn this many times as large. */
  exaggerate(heightScale: number): void {
    const [x, y, z] = this.orbit.target;
    const target = [x, y, (z * heightScale) / this.heightScale] as const;
    this.heightScale = heightScale;
    this.orbit = { ...this.orbit, target };
    this.setBox(this.box);
    this.onChange();
  }

  /** Shows everything, from a direction or from the present one. */
  fit(direction: Direction | null = null): void {
    if (direction !== null) this.orbit = { ...this.orbit, ...kDirections[direction] };
    this.fits = true;
    this.refit();
    this.onChange();
  }

  turn(dx_px: number, dy_px: number): void {
    this.move(rotated(this.orbit, dx_px, dy_px));
  }

  pan(dx_px: number, dy_px: number): void {
    this.move(panned(this.orbit, dx_px, dy_px));
  }

  zoom(factor: number, at: readonly [number, number] | null): void {
    const { width_px, height_px } = this.size;
    const fixed = at ?? [width_px / 2, height_px / 2];
    this.move(zoomedAbout(this.orbit, this.size, fixed, factor));
  }

  get current(): OrbitView {
    return this.orbit;
  }

  get map(): ScreenMap {
    return screenMap(this.orbit, this.size, this.heightScale);
  }

  /** Around all that is drawn. */
  get drawnBox(): Box3 {
    return boxOfScales(this.scales);
  }

  private move(orbit: OrbitView): void {
    this.orbit = orbit;
    this.fits = false;
    this.onChange();
  }

  private refit(): void {
    if (!this.fits) return;
    this.orbit = fittedTo(this.orbit, this.drawnBox, this.size, this.heightScale);
  }
}
