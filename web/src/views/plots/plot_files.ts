// The menu that saves the plots shown: CSV, SVG or PNG.
import { plotsCsv, plotsSvg } from '../../store/plots/plot_export';
import type { PlotSpec } from '../../store/plots/plot_specs';
import type { Span } from '../../store/time_window';
import { curveStyle } from '../colours';
import { download } from '../download';
import { h } from '../dom';
import { paint } from '../paint';

const kFormats = [
  { format: 'csv', label: 'CSV', hint: 'all values' },
  { format: 'svg', label: 'SVG', hint: 'the plots as shown' },
  { format: 'png', label: 'PNG', hint: 'the plots as shown' },
] as const;
type Format = (typeof kFormats)[number]['format'];

export interface ShownPlots {
  group: string;
  specs: readonly PlotSpec[];
  span_s: Span;
  columns: number;
}

/** @param shown  null = nothing can be saved */
export function plotFilesMenu(
  shown: () => ShownPlots | null,
  failed: (text: string) => void,
): HTMLSelectElement {
  const menu = h(
    'select',
    { class: 'plot-files', 'aria-label': 'Save the plots', title: 'Saves the plots as a file' },
    h('option', { value: '' }, 'Save'),
    ...kFormats.map(({ format, label, hint }) =>
      h('option', { value: format, title: hint }, label),
    ),
  );
  menu.addEventListener('change', () => {
    const format = menu.value as Format;
    menu.value = '';
    const plots = shown();
    if (plots === null) return;
    save(plots, format).catch((error: unknown) =>
      failed(`The plots cannot be saved: ${String(error)}`),
    );
  });
  return menu;
}

async function save({ group, specs, span_s, columns }: ShownPlots, format: Format): Promise<void> {
  const name = `overfly-${group}.${format}`;
  if (format === 'csv') {
    download(name, new Blob([plotsCsv(specs)], { type: 'text/csv' }));
    return;
  }
  const svg = plotsSvg(specs, span_s, columns, {
    background: paint('var(--panel)'),
    text: paint('var(--text)'),
    grid: paint('var(--grid)'),
    curve: (hue) => {
      const style = curveStyle(hue);
      return { ...style, colour: paint(style.colour) };
    },
  });
  const blob = new Blob([svg], { type: 'image/svg+xml' });
  download(name, format === 'svg' ? blob : await pngOf(blob));
}

/** At twice the size, so that it is sharp on paper. */
async function pngOf(svg: Blob): Promise<Blob> {
  const url = URL.createObjectURL(svg);
  try {
    const image = new Image();
    image.src = url;
    await image.decode();
    const canvas = h('canvas', { width: image.width * 2, height: image.height * 2 });
    canvas.getContext('2d')?.drawImage(image, 0, 0, canvas.width, canvas.height);
    return await new Promise((resolve, reject) => {
      canvas.toBlob((blob) => {
        if (blob === null) reject(new Error('the picture is too large'));
        else resolve(blob);
      }, 'image/png');
    });
  } finally {
    URL.revokeObjectURL(url);
  }
}
