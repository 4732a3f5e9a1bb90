// Steers the 3D view with the mouse, fingers and, in the free mode, the keyboard.
import type { Context } from '../view';

const kTurn_deg_px = 0.35;
const kLook_deg_px = 0.12;
const kZoom_per_px = 0.0012;
/** Of the free flight, by the height above the origin [m/s]. */
const kSpeed_per_m = 0.7;
const kSpeedRange_m_s = [12, 3000] as const;
const kFast = 5;
/** A wheel's click moves as far as flying for this time. */
const kWheel_s_px = 0.004;

type Move = readonly [ahead: number, right: number, up: number];

const kMoves: Readonly<Record<string, Move>> = {
  w: [1, 0, 0],
  s: [-1, 0, 0],
  d: [0, 1, 0],
  a: [0, -1, 0],
  e: [0, 0, 1],
  q: [0, 0, -1],
};

export function steerScene(context: Context, area: HTMLElement): void {
  steerByPointer(context, area);
  steerByKeys(context, area);
}

function steerByPointer({ scene, store }: Context, area: HTMLElement): void {
  /** Where the pointer that steers was; others do nothing. */
  let last: { id: number; x: number; y: number } | null = null;
  area.addEventListener('pointerdown', (event) => {
    const onTool = event.target instanceof Element && event.target.closest('.scene-sheet') !== null;
    if (event.button !== 0 || onTool) return;
    if (last !== null && area.hasPointerCapture(last.id)) return;
    last = { id: event.pointerId, x: event.clientX, y: event.clientY };
    area.setPointerCapture(event.pointerId);
  });
  area.addEventListener('pointermove', (event) => {
    if (last?.id !== event.pointerId) return;
    const { mode, orbits } = store.state.scene;
    const { azimuth_deg, elevation_deg } = orbits[mode];
    const [x, y] = [event.clientX - last.x, event.clientY - last.y];
    // Around a target the mouse turns the world; from a viewpoint it pulls the view along.
    const looks = mode === 'free' || mode === 'onboard';
    scene.orbit({
      azimuth_deg: azimuth_deg + x * (looks ? -kLook_deg_px : kTurn_deg_px),
      elevation_deg: elevation_deg + y * (looks ? kLook_deg_px : kTurn_deg_px),
    });
    last = { id: event.pointerId, x: event.clientX, y: event.clientY };
  });
  const release = ({ pointerId }: PointerEvent) => {
    if (last?.id === pointerId) last = null;
  };
  area.addEventListener('pointerup', release);
  area.addEventListener('pointercancel', release);
  area.addEventListener('dblclick', () => scene.toggleFollow());
  area.addEventListener(
    'wheel',
    (event) => {
      event.preventDefault();
      const { mode, orbits, eye } = store.state.scene;
      if (mode === 'free') {
        const ahead_m = -event.deltaY * kWheel_s_px * speed_m_s(eye.z_m);
        scene.fly({ ahead_m, right_m: 0, up_m: 0 });
      } else if (mode !== 'onboard') {
        const factor = Math.exp(event.deltaY * kZoom_per_px);
        scene.orbit({ distance_m: orbits[mode].distance_m * factor });
      }
    },
    { passive: false },
  );
}

function speed_m_s(height_m: number): number {
  const [low, high] = kSpeedRange_m_s;
  return Math.min(high, Math.max(low, kSpeed_per_m * Math.abs(height_m)));
}

/** Keys fly while they are held, as long as the panel is on the screen. */
function steerByKeys({ scene, store }: Context, area: HTMLElement): void {
  const held = new Set<string>();
  let fast = false;
  let before_ms = 0;
  const fly = (now_ms: number) => {
    const { mode, eye } = store.state.scene;
    if (held.size === 0 || mode !== 'free' || !area.isConnected) {
      held.clear();
      return;
    }
    const seconds = Math.min(0.1, (now_ms - before_ms) / 1000);
    before_ms = now_ms;
    const way_m = seconds * speed_m_s(eye.z_m) * (fast ? kFast : 1);
    const sum = [0, 0, 0];
    for (const key of held) kMoves[key]?.forEach((part, i) => (sum[i] = (sum[i] ?? 0) + part));
    const [ahead = 0, right = 0, up = 0] = sum;
    scene.fly({ ahead_m: ahead * way_m, right_m: right * way_m, up_m: up * way_m });
    requestAnimationFrame(fly);
  };
  document.addEventListener('keydown', (event) => {
    const key = event.key.toLowerCase();
    fast = event.shiftKey;
    const typing = event.target instanceof Element && event.target.matches('input,select,textarea');
    const other = event.ctrlKey || event.metaKey || event.altKey || typing;
    const covered = !area.isConnected || area.closest('[inert]') !== null;
    if (other || covered || !(key in kMoves) || store.state.scene.mode !== 'free') return;
    event.preventDefault();
    if (held.has(key)) return;
    held.add(key);
    if (held.size > 1) return;
    before_ms = performance.now();
    requestAnimationFrame(fly);
  });
  document.addEventListener('keyup', (event) => {
    fast = event.shiftKey;
    held.delete(event.key.toLowerCase());
  });
  window.addEventListener('blur', () => held.clear());
}
