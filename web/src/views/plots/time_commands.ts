// What keys do while the plots over time have the focus; the command palette offers the same.
import type { PlotTime } from '../../store/plots/plot_time';

/** Of the time shown. */
const kStep = 0.1;
const kZoom = 1.25;

interface TimeCommand {
  keys: readonly string[];
  label: string;
  title: string;
  run: (time: PlotTime) => void;
}

export const kTimeCommands: readonly TimeCommand[] = [
  { keys: ['0'], label: '0', title: 'Plots: the whole flight', run: (time) => time.showWhole() },
  {
    keys: ['+', '='],
    label: '+',
    title: 'Plots: zoom in',
    run: (time) => time.zoomAtClock(1 / kZoom),
  },
  { keys: ['-'], label: '−', title: 'Plots: zoom out', run: (time) => time.zoomAtClock(kZoom) },
  { keys: ['ArrowLeft'], label: '←', title: 'Plots: earlier', run: (time) => step(time, -kStep) },
  { keys: ['ArrowRight'], label: '→', title: 'Plots: later', run: (time) => step(time, kStep) },
];

function step(time: PlotTime, share: number): void {
  const [low, high] = time.shown_s;
  time.pan(share * (high - low));
}

/** Plots that can get the focus: they take the keys instead of the screen. */
export function takeTimeKeys(plots: HTMLElement, time: PlotTime): void {
  plots.addEventListener('keydown', (event) => {
    const held = event.ctrlKey || event.metaKey || event.altKey;
    // Some keyboards have + only with Shift.
    if (held || (event.shiftKey && event.key !== '+')) return;
    const command = kTimeCommands.find(({ keys }) => keys.includes(event.key));
    if (command === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    command.run(time);
  });
  // After a click the keys of the screen go on working.
  plots.addEventListener('click', () => plots.blur());
}
