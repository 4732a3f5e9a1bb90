// Draws the lines of the tracks with WebGL, on demand. The browser may take its context away.
import {
  ColorManagement,
  Group,
  LinearSRGBColorSpace,
  OrthographicCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from 'three';
import type { Box3 } from '../../store/plot3d/axis_box';
import type { OrbitView } from '../../store/plot3d/orbit_view';
import { screenAxes } from '../../store/plot3d/orbit_view';
import type { Size } from '../../store/plots/path_frame';
import type { Rgb } from './rgb';
import type { TrackLine } from './track_line';
import { lineUniforms } from './track_line';

// The colours of the style sheet go to the screen as they are.
ColorManagement.enabled = false;

const kMostRatio = 2;
const kMostPoints = 100_000;
const kMostPointsWithoutGpu = 20_000;
/** Of Chromium, of Mesa and of Windows. */
const kSoftware = /swiftshader|llvmpipe|softpipe|software|basic render/i;

export class LineStage {
  readonly uniforms = lineUniforms();
  private readonly scene = new Scene();
  /** Exaggerates heights. */
  private readonly group = new Group();
  private readonly camera = new OrthographicCamera();

  private constructor(
    private readonly renderer: WebGLRenderer,
    /** Points of all lines together that are drawn fluently. */
    readonly mostPoints: number,
  ) {
    renderer.outputColorSpace = LinearSRGBColorSpace;
    renderer.setClearAlpha(0);
    this.scene.add(this.group);
  }

  /** null if the browser has no WebGL 2. Without a GPU it draws fewer points, and rougher edges. */
  static open(canvas: HTMLCanvasElement): LineStage | null {
    const gpu = hasGpu();
    const context = canvas.getContext('webgl2', { antialias: gpu });
    if (context === null) return null;
    const mostPoints = gpu ? kMostPoints : kMostPointsWithoutGpu;
    return new LineStage(new WebGLRenderer({ canvas, context }), mostPoints);
  }

  add(line: TrackLine): void {
    this.group.add(line.mesh);
  }

  remove(line: TrackLine): void {
    this.group.remove(line.mesh);
    line.dispose();
  }

  setGround(colour: Rgb): void {
    this.uniforms.ground.value.set(...colour);
  }

  /** @param box  around all that is drawn, heights not exaggerated */
  draw(view: OrbitView, size: Size, box: Box3, heightScale: number): void {
    const { camera, renderer, group } = this;
    const { width_px, height_px } = size;
    this.fit(size);
    group.scale.z = heightScale;
    const { up, ahead } = screenAxes(view);
    const target = new Vector3(...view.target);
    const depth_m = depthOf(target, box, heightScale);
    camera.up.set(...up);
    camera.position.copy(target).addScaledVector(new Vector3(...ahead), -depth_m);
    camera.lookAt(target);
    [camera.left, camera.right] = halves(width_px * view.m_per_px);
    [camera.bottom, camera.top] = halves(height_px * view.m_per_px);
    [camera.near, camera.far] = [0, 2 * depth_m];
    camera.updateProjectionMatrix();
    renderer.render(this.scene, camera);
  }

  /** A new size empties the canvas. */
  private fit({ width_px, height_px }: Size): void {
    const { renderer, uniforms } = this;
    const ratio = Math.min(kMostRatio, window.devicePixelRatio);
    const known = uniforms.size_px.value;
    const same = known.x === width_px && known.y === height_px;
    if (same && renderer.getPixelRatio() === ratio) return;
    known.set(width_px, height_px);
    renderer.setPixelRatio(ratio);
    renderer.setSize(width_px, height_px, false);
  }
}

/** A distance from the target within which the whole box lies [m]. */
function depthOf(target: Vector3, { min, max }: Box3, heightScale: number): number {
  const scale = new Vector3(1, 1, heightScale);
  const [low, high] = [new Vector3(...min).multiply(scale), new Vector3(...max).multiply(scale)];
  const radius_m = low.distanceTo(high) / 2;
  return 1.1 * radius_m + low.lerp(high, 0.5).distanceTo(target);
}

function halves(whole: number): [number, number] {
  return [-whole / 2, whole / 2];
}

/** Whether a GPU draws WebGL, by the name of the renderer if the browser gives it. */
function hasGpu(): boolean {
  const context = document.createElement('canvas').getContext('webgl2');
  if (context === null) return false;
  const info = context.getExtension('WEBGL_debug_renderer_info');
  const name = String(context.getParameter(info?.UNMASKED_RENDERER_WEBGL ?? context.RENDERER));
  context.getExtension('WEBGL_lose_context')?.loseContext();
  return !kSoftware.test(name);
}
