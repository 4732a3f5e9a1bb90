// How well the views cover the image, the sizes and the tilts of the board.
import type { CoverageBar } from '../../protocol/calibration_types';
import { h, rebuild } from '../dom';

const kBars: Readonly<Record<string, { label: string; hint: string }>> = {
  x: { label: 'Across', hint: 'Show the board at the left and at the right edge of the image' },
  y: { label: 'Down', hint: 'Show the board at the top and at the bottom of the image' },
  size: { label: 'Size', hint: 'Bring the board nearer, so that it fills more of the image' },
  skew: { label: 'Tilt', hint: 'Tilt the board by 20 to 45 degrees, in different directions' },
};

export class CoverageBars {
  readonly root = h('div', { class: 'coverage', 'data-role': 'coverage' });

  show(bars: readonly CoverageBar[]): void {
    rebuild(this.root, JSON.stringify(bars), () => bars.map((bar) => barOf(bar)));
  }
}

function barOf({ name, min, max, progress }: CoverageBar): HTMLElement {
  const { label, hint } = kBars[name] ?? { label: name, hint: '' };
  const percent = Math.round(100 * progress);
  const full = progress >= 1;
  return h(
    'div',
    {
      class: full ? 'coverage-bar full' : 'coverage-bar',
      title: full ? `${label}: enough` : hint,
      role: 'meter',
      'aria-label': label,
      'aria-valuemin': 0,
      'aria-valuemax': 100,
      'aria-valuenow': percent,
      'data-bar': name,
    },
    h('span', { class: 'coverage-name' }, label),
    h(
      'span',
      { class: 'coverage-track' },
      h('span', {
        class: 'coverage-range',
        style: `left:${100 * min}%;width:${Math.max(1, 100 * (max - min))}%`,
      }),
    ),
    h('span', { class: 'coverage-share' }, `${percent} %`),
  );
}
