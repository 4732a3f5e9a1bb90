// Steers the 3D plot. Dragging turns it, with the right button or Shift it moves; the wheel zooms at
// the mouse. One finger turns, two move and zoom. Keys while it has the focus.
const kZoom_per_px = 0.0015;
const kClick_px = 4;
const kKeyZoom = 1.25;
const kKeyTurn_px = 26;

export type Pixel = [number, number];

export interface Steering {
  turn: (dx_px: number, dy_px: number) => void;
  pan: (dx_px: number, dy_px: number) => void;
  /** A factor below 1 shows less; null = about the middle. */
  zoom: (factor: number, at: Pixel | null) => void;
  fit: () => void;
  /** null when the mouse leaves. */
  point: (at: Pixel | null) => void;
  click: (at: Pixel) => void;
}

export function steerPlot(area: HTMLElement, steering: Steering): void {
  steerByPointers(area, steering);
  area.addEventListener('dblclick', () => steering.fit());
  area.addEventListener('contextmenu', (event) => event.preventDefault());
  area.addEventListener(
    'wheel',
    (event) => {
      event.preventDefault();
      steering.zoom(Math.exp(event.deltaY * kZoom_per_px), pixelIn(area, event));
    },
    { passive: false },
  );
  area.addEventListener('keydown', (event) => onKey(event, steering));
}

function steerByPointers(area: HTMLElement, steering: Steering): void {
  const pointers = new Map<number, Pixel>();
  /** The press has not moved, and may become a click. */
  let pressed: Pixel | null = null;
  let pans = false;
  area.addEventListener('pointerdown', (event) => {
    const at = pixelIn(area, event);
    pointers.set(event.pointerId, at);
    pressed = event.button === 0 && pointers.size === 1 ? at : null;
    pans = event.button !== 0 || event.shiftKey;
    area.setPointerCapture(event.pointerId);
  });
  area.addEventListener('pointermove', (event) => {
    const at = pixelIn(area, event);
    const before = pointers.get(event.pointerId);
    if (before === undefined) {
      steering.point(at);
      return;
    }
    const [dx, dy] = [at[0] - before[0], at[1] - before[1]];
    if (pressed !== null && Math.hypot(dx, dy) < kClick_px) return;
    pressed = null;
    pointers.set(event.pointerId, at);
    const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
    if (other !== undefined) movePair(steering, before, at, other);
    else if (pans) steering.pan(dx, dy);
    else steering.turn(dx, dy);
  });
  area.addEventListener('pointerup', (event) => {
    pointers.delete(event.pointerId);
    if (pressed !== null) steering.click(pressed);
    pressed = null;
  });
  area.addEventListener('pointercancel', (event) => {
    pointers.delete(event.pointerId);
    pressed = null;
  });
  area.addEventListener('pointerleave', () => steering.point(null));
}

/** One of two fingers has moved: what is between them follows. */
function movePair({ pan, zoom }: Steering, before: Pixel, at: Pixel, other: Pixel): void {
  const apart = ([x, y]: Pixel) => Math.max(1, Math.hypot(x - other[0], y - other[1]));
  pan((at[0] - before[0]) / 2, (at[1] - before[1]) / 2);
  zoom(apart(before) / apart(at), [(at[0] + other[0]) / 2, (at[1] + other[1]) / 2]);
}

/** The rest of the screen does not get these keys. */
function onKey(event: KeyboardEvent, { turn, pan, zoom, fit }: Steering): void {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const move = event.shiftKey ? pan : turn;
  const actions: Readonly<Record<string, () => void>> = {
    '+': () => zoom(1 / kKeyZoom, null),
    '=': () => zoom(1 / kKeyZoom, null),
    '-': () => zoom(kKeyZoom, null),
    '0': fit,
    ArrowLeft: () => move(-kKeyTurn_px, 0),
    ArrowRight: () => move(kKeyTurn_px, 0),
    ArrowUp: () => move(0, -kKeyTurn_px),
    ArrowDown: () => move(0, kKeyTurn_px),
  };
  const action = actions[event.key];
  if (action === undefined) return;
  event.preventDefault();
  event.stopPropagation();
  action();
}

function pixelIn(area: HTMLElement, event: MouseEvent): Pixel {
  const { left, top } = area.getBoundingClientRect();
  return [event.clientX - left, event.clientY - top];
}
