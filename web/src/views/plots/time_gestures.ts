// Mouse and fingers on a plot over time. A click or a drag seeks; with Shift, or another button than
// the left one, a drag moves the plots. The wheel zooms; with Shift, or sideways, it moves. Two fingers
// move and zoom.
import { promptlyPerFrame } from '../dom';

const kZoom_per_px = 0.0015;
/** A finger that moves farther seeks at once; else it seeks when it is lifted. */
const kTap_px = 4;

export interface TimeGestures {
  /** All in pixels of the plot's width. */
  seek: (x_px: number) => void;
  /** The curves move with the pointer. */
  pan: (dx_px: number) => void;
  /** A factor below 1 shows less. */
  zoom: (x_px: number, factor: number) => void;
  showWhole: () => void;
}

export function steerTime(over: HTMLElement, gestures: TimeGestures): void {
  steerByPointers(over, gestures);
  over.addEventListener('dblclick', () => gestures.showWhole());
  over.addEventListener('contextmenu', (event) => event.preventDefault());
  // The middle button would scroll the page.
  over.addEventListener('mousedown', (event) => {
    if (event.button === 1) event.preventDefault();
  });
  over.addEventListener(
    'wheel',
    (event) => {
      event.preventDefault();
      const { deltaX, deltaY, shiftKey } = event;
      if (shiftKey || Math.abs(deltaX) > Math.abs(deltaY)) {
        gestures.pan(-(Math.abs(deltaX) > Math.abs(deltaY) ? deltaX : deltaY));
      } else {
        gestures.zoom(xIn(over, event), Math.exp(deltaY * kZoom_per_px));
      }
    },
    { passive: false },
  );
}

function steerByPointers(over: HTMLElement, gestures: TimeGestures): void {
  const pointers = new Map<number, number>();
  let act: 'seek' | 'pan' | 'tap' | null = null;
  const seek = promptlyPerFrame((x_px: number) => gestures.seek(x_px));
  over.addEventListener('pointerdown', (event) => {
    const x_px = xIn(over, event);
    pointers.set(event.pointerId, x_px);
    over.setPointerCapture(event.pointerId);
    const moves = pointers.size > 1 || event.button !== 0 || event.shiftKey;
    act = moves ? 'pan' : event.pointerType === 'touch' ? 'tap' : 'seek';
    if (act === 'seek') seek(x_px);
  });
  over.addEventListener('pointermove', (event) => {
    const before_px = pointers.get(event.pointerId);
    if (before_px === undefined) return;
    const x_px = xIn(over, event);
    if (act === 'tap' && Math.abs(x_px - before_px) < kTap_px) return;
    if (act === 'tap') act = 'seek';
    pointers.set(event.pointerId, x_px);
    if (act === 'seek') seek(x_px);
    if (act !== 'pan') return;
    const other_px = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
    if (other_px === undefined) gestures.pan(x_px - before_px);
    else movePair(gestures, before_px, x_px, other_px);
  });
  over.addEventListener('pointerup', (event) => {
    pointers.delete(event.pointerId);
    if (act === 'tap') seek(xIn(over, event));
    // A finger that remains goes on moving.
    if (pointers.size === 0) act = null;
  });
  over.addEventListener('pointercancel', (event) => {
    pointers.delete(event.pointerId);
    if (pointers.size === 0) act = null;
  });
}

/** One of two fingers has moved: the times below both stay there. */
function movePair(
  { pan, zoom }: TimeGestures,
  before_px: number,
  x_px: number,
  other_px: number,
): void {
  const apart = (at_px: number) => Math.max(8, Math.abs(at_px - other_px));
  pan((x_px - before_px) / 2);
  zoom((x_px + other_px) / 2, apart(before_px) / apart(x_px));
}

function xIn(over: HTMLElement, { clientX }: MouseEvent): number {
  return clientX - over.getBoundingClientRect().left;
}
