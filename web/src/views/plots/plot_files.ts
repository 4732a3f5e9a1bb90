// The menu that saves what a panel shows: CSV, SVG or PNG.
import { plotsCsv, plotsSvg } from '../../store/plots/plot_export';
import type { PlotSpec } from '../../store/plots/plot_specs';
import type { Span } from '../../store/playback/time_window';
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

/** What is saved. PNG is the picture of the SVG file. */
export interface PlotFile {
  /** Of the file, without its ending. */
  name: string;
  csv: () => string;
  svg: () => string;
}

export interface ShownPlots {
  group: string;
  specs: readonly PlotSpec[];
  span_s: Span;
  columns: number;
}

/** @param content  null = nothing can be saved */
export function saveMenu(
  content: () => PlotFile | null,
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
    const file = content();
    if (file === null) return;
    save(file, format).catch((error: unknown) =>
      failed(`The plots cannot be saved: ${String(error)}`),
    );
  });
  return menu;
}

export function timePlotsFile({ group, specs, span_s, columns }: ShownPlots): PlotFile {
  return {
    name: group,
    csv: () => plotsCsv(specs),
    svg: () =>
      plotsSvg(specs, span_s, columns, {
        background: paint('var(--panel)'),
        text: paint('var(--text)'),
        grid: paint('var(--grid)'),
        curve: (hue) => {
          const style = curveStyle(hue);
          return { ...style, colour: paint(style.colour) };
        },
      }),
  };
}

async function save({ name, csv, svg }: PlotFile, format: Format): Promise<void> {
  const file = `overfly-${name}.${format}`;
  if (format === 'csv') {
    download(file, new Blob([csv()], { type: 'text/csv' }));
    return;
  }
  const blob = new Blob([svg()], { type: 'image/svg+xml' });
  download(file, format === 'svg' ? blob : await pngOf(blob));
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
