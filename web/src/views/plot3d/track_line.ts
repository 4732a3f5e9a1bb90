// The line of a track in WebGL: a ribbon of constant width on the screen. Up to the clock's time it is
// broad and in full colour, after it narrow and faint; only a uniform changes with the clock.
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  DynamicDrawUsage,
  GLSL3,
  InterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  ShaderMaterial,
  Vector2,
  Vector3,
} from 'three';
import type { DisplayTrack } from '../../store/plot3d/display_track';
import { kGap_s, kPointSize } from '../../store/plot3d/display_track';
import type { CurveStyle } from '../colours';
import type { Rgb } from './rgb';

/** The part after the clock's time: how much of the width and of the colour. */
export const kLaterWidth = 0.5;
const kLaterColour = 0.42;
export const kBroader_px = 0.75;
/** An estimate is drawn over a truth that it agrees with; of the depth of the plot. */
const kDepthStep = 1e-3;

// Every corner of a line between two points has both points. Instances would need a quarter of the
// memory, but browsers without a GPU draw each of them on its own.
const kCorners = 4;
const kCornerSize = 2 * kPointSize;

const kVertexShader = `
  in vec4 begin;
  in float beginLength;
  in vec4 end;
  in float endLength;
  uniform vec2 size_px;
  uniform float width_px;
  uniform float now_s;
  uniform float depthStep;
  out float t_s;
  out float length_m;

  void main() {
    // Along the line 0 or 1, across it -1 or 1.
    vec2 corner = vec2(float((gl_VertexID >> 1) & 1), float(gl_VertexID & 1) * 2.0 - 1.0);
    t_s = mix(begin.w, end.w, corner.x);
    length_m = mix(beginLength, endLength, corner.x);
    if (begin.w <= ${kGap_s.toFixed(1)} || end.w <= ${kGap_s.toFixed(1)}) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      return;
    }
    vec4 from = projectionMatrix * modelViewMatrix * vec4(begin.xyz, 1.0);
    vec4 to = projectionMatrix * modelViewMatrix * vec4(end.xyz, 1.0);
    vec2 way_px = (to.xy - from.xy) * 0.5 * size_px;
    float way = length(way_px);
    vec2 along = way > 1e-4 ? way_px / way : vec2(1.0, 0.0);
    float half_px = 0.5 * width_px * (begin.w <= now_s ? 1.0 : ${kLaterWidth.toFixed(2)});
    // Longer by half its width, so that no notch is left between two lines.
    vec2 off_px = half_px * ((2.0 * corner.x - 1.0) * along + corner.y * vec2(-along.y, along.x));
    vec4 place = mix(from, to, corner.x);
    gl_Position = vec4(place.xy + 2.0 * off_px / size_px, place.z - depthStep, 1.0);
  }`;

const kFragmentShader = `
  uniform vec3 colour;
  uniform vec3 ground;
  uniform float now_s;
  uniform float period_m;
  uniform vec3 dash;
  in float t_s;
  in float length_m;
  out vec4 shown;

  void main() {
    float place = fract(length_m / period_m);
    if (place > dash.x && (place < dash.y || place > dash.z)) discard;
    shown = vec4(mix(ground, colour, t_s <= now_s ? 1.0 : ${kLaterColour.toFixed(2)}), 1.0);
  }`;

/** What all lines of a plot have in common. */
export interface LineUniforms {
  size_px: { value: Vector2 };
  ground: { value: Vector3 };
}

export function lineUniforms(): LineUniforms {
  return { size_px: { value: new Vector2(1, 1) }, ground: { value: new Vector3() } };
}

export class TrackLine {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private corners = new Float32Array(0);
  private buffer: InterleavedBuffer | null = null;
  private readonly own = {
    colour: { value: new Vector3() },
    width_px: { value: 1 },
    now_s: { value: Infinity },
    depthStep: { value: 0 },
    period_m: { value: 1 },
    dash: { value: new Vector3(1, 1, 1) },
  };
  private dash_px = 0;

  constructor(shared: LineUniforms) {
    const material = new ShaderMaterial({
      uniforms: { ...shared, ...this.own },
      vertexShader: kVertexShader,
      fragmentShader: kFragmentShader,
      glslVersion: GLSL3,
      side: DoubleSide,
    });
    this.mesh = new Mesh(new BufferGeometry(), material);
    // The box of its points is not known to the library.
    this.mesh.frustumCulled = false;
  }

  /** @param first  point that may have changed */
  setPoints({ points, count }: DisplayTrack, first: number): void {
    const lines = Math.max(0, count - 1);
    const capacity = points.length / kPointSize;
    const enlarged = this.corners.length !== capacity * kCorners * kCornerSize;
    const from = enlarged ? 0 : Math.max(0, first - 1);
    if (enlarged) this.enlarge(capacity);
    for (let line = from; line < lines; line += 1) {
      const both = points.subarray(line * kPointSize, (line + 2) * kPointSize);
      for (let corner = 0; corner < kCorners; corner += 1) {
        this.corners.set(both, (line * kCorners + corner) * kCornerSize);
      }
    }
    if (this.buffer !== null && from < lines) {
      const size = kCorners * kCornerSize;
      this.buffer.addUpdateRange(from * size, (lines - from) * size);
      this.buffer.needsUpdate = true;
    }
    this.mesh.geometry.setDrawRange(0, lines * kIndices.length);
    this.mesh.visible = lines > 0;
  }

  /** @param order  lines with a higher one lie above */
  setStyle({ width_px, dash }: CurveStyle, colour: Rgb, order: number): void {
    const { own } = this;
    own.colour.value.set(...colour);
    own.width_px.value = width_px + kBroader_px;
    own.depthStep.value = order * kDepthStep;
    const sum_px = dash.reduce((sum, part) => sum + part, 0);
    this.dash_px = sum_px;
    const [on = 1, off = 0, again = 0] = dash.map((part) => part / sum_px);
    own.dash.value.set(on, on + off, on + off + again);
  }

  /** @param now_s  time of the run @param m_per_px  of the plot */
  setInstant(now_s: number, m_per_px: number): void {
    this.own.now_s.value = now_s;
    // In steps, so that dashes do not run along the line while the view is zoomed.
    this.own.period_m.value = Math.max(1, this.dash_px) * 2 ** Math.round(Math.log2(m_per_px));
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  private enlarge(lines: number): void {
    this.corners = new Float32Array(lines * kCorners * kCornerSize);
    this.buffer = new InterleavedBuffer(this.corners, kCornerSize).setUsage(DynamicDrawUsage);
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometryOf(this.buffer, lines);
  }
}

/** Of the two triangles of a line. */
const kIndices = [0, 1, 2, 2, 1, 3] as const;

function geometryOf(buffer: InterleavedBuffer, lines: number): BufferGeometry {
  const geometry = new BufferGeometry();
  const indices = new Uint32Array(lines * kIndices.length);
  for (let i = 0; i < indices.length; i += 1) {
    const line = Math.floor(i / kIndices.length);
    indices[i] = line * kCorners + (kIndices[i % kIndices.length] ?? 0);
  }
  geometry.setIndex(new BufferAttribute(indices, 1));
  const part = (size: number, offset: number) =>
    new InterleavedBufferAttribute(buffer, size, offset);
  geometry.setAttribute('begin', part(4, 0));
  geometry.setAttribute('beginLength', part(1, 4));
  geometry.setAttribute('end', part(4, kPointSize));
  geometry.setAttribute('endLength', part(1, kPointSize + 4));
  return geometry;
}
