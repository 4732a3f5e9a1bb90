// Plots as files: CSV with all values, SVG with the curves as they are drawn.
import { csvLine } from '../csv';
import { decimated } from './curve';
import { ticks, tickText } from './path_frame';
import type { CurveHue, PlotSpec } from './plot_specs';
import { paddedRange } from './plot_range';
import { curveExtent, legendNames, sharedExtent } from './shared_extent';
import { escaped, svgFile } from './svg_pen';
import type { Span } from '../playback/time_window';

/** All values of all curves: one line each. Times are those of the clock. */
export function plotsCsv(specs: readonly PlotSpec[]): string {
  const lines = [csvLine(['plot', 'unit', 'curve', 't_s', 'value'])];
  for (const { key, unit, curves } of specs) {
    for (const { name, curve } of curves) {
      const now = curve();
      if (now === null) continue;
      const { t, t_scale_s, t_offset_s, values, scale } = now;
      for (let row = 0; row < t.length; row += 1) {
        const value = (values[row] ?? NaN) * scale;
        const t_s = (t[row] ?? NaN) * t_scale_s + t_offset_s;
        lines.push(csvLine([key, unit, name, round(t_s, 9), Number.isNaN(value) ? '' : value]));
      }
    }
  }
  return lines.join('');
}

/** Nanoseconds as seconds without the digits that the division adds. */
function round(value: number, digits: number): number {
  return Number(value.toFixed(digits));
}

export interface SvgStyle {
  background: string;
  text: string;
  grid: string;
  curve: (hue: CurveHue) => { colour: string; width_px: number; dash: number[] };
}

const kWidth_px = 480;
const kHeight_px = 260;
const kLeft_px = 56;
const kRight_px = 14;
export const kTop_px = 40;
const kBottom_px = 34;
const kTickSpace_px = 60;
const kFont = 'font-family="system-ui, sans-serif" font-size="11"';

/** The plots next to each other, with axes, units and the names of the curves. */
export function plotsSvg(
  specs: readonly PlotSpec[],
  span_s: Span,
  columns: number,
  style: SvgStyle,
): string {
  const across = Math.min(columns, Math.max(1, specs.length));
  const down = Math.ceil(specs.length / across);
  const [width, height] = [across * kWidth_px, down * kHeight_px];
  const plots = specs.map((spec, i) => {
    const [x, y] = [(i % across) * kWidth_px, Math.floor(i / across) * kHeight_px];
    return `<g transform="translate(${x} ${y})">${onePlot(spec, span_s, style)}</g>`;
  });
  return svgFile(width, height, style.background, plots.join(''));
}

function onePlot(spec: PlotSpec, span_s: Span, style: SvgStyle): string {
  const plotWidth = kWidth_px - kLeft_px - kRight_px;
  const plotHeight = kHeight_px - kTop_px - kBottom_px;
  const lines = spec.curves.map(({ curve }) => {
    const now = curve();
    return now === null ? { t_s: [], values: [] } : decimated(now, span_s, plotWidth * 2);
  });
  const extents = lines.map((line, i) =>
    curveExtent(line, span_s, spec.unbounded === true && spec.curves[i]?.hue.kind === 'estimate'),
  );
  const shared = sharedExtent(extents, spec.least);
  const [low, high] = paddedRange(
    shared?.low[0] ?? Infinity,
    shared?.high[0] ?? -Infinity,
    spec.least,
  );
  const x = (t_s: number) => kLeft_px + ((t_s - span_s[0]) / (span_s[1] - span_s[0])) * plotWidth;
  const y = (value: number) => kTop_px + (1 - (value - low) / (high - low)) * plotHeight;
  const paths = lines.map(({ t_s, values }, i) => {
    const hue = spec.curves[i]?.hue ?? { kind: 'run', order: 0 };
    const { colour, width_px, dash } = style.curve(hue);
    let drawing = false;
    const steps = t_s.map((t, k) => {
      const value = values[k] ?? NaN;
      const move = drawing ? 'L' : 'M';
      drawing = !Number.isNaN(value);
      return drawing ? `${move}${x(t).toFixed(1)} ${y(value).toFixed(1)}` : '';
    });
    const dashes = dash.length === 0 ? '' : ` stroke-dasharray="${dash.join(' ')}"`;
    return `<path d="${steps.join('')}" fill="none" stroke="${colour}" stroke-width="${width_px}"${dashes}/>`;
  });
  const area = { x, y, low, high, plotWidth, plotHeight };
  const clip = `<svg x="${kLeft_px}" y="${kTop_px}" width="${plotWidth}" height="${plotHeight}" viewBox="${kLeft_px} ${kTop_px} ${plotWidth} ${plotHeight}">${paths.join('')}</svg>`;
  return titles(spec, shared?.beyond ?? [], style) + axes(span_s, area, style) + clip;
}

interface Area {
  x: (t_s: number) => number;
  y: (value: number) => number;
  low: number;
  high: number;
  plotWidth: number;
  plotHeight: number;
}

function titles(
  { label, unit, curves }: PlotSpec,
  beyond: readonly number[],
  style: SvgStyle,
): string {
  const names = legendNames(curves, beyond).map(({ name, hue }) => ({
    name,
    colour: style.curve(hue).colour,
  }));
  return svgTitles(kLeft_px, unit === '' ? label : `${label} [${unit}]`, names, style.text);
}

/** A title, and below it the names of the curves in their colours. Both take `kTop_px`. */
export function svgTitles(
  x: number,
  title: string,
  names: readonly { name: string; colour: string }[],
  colour: string,
): string {
  const spans = names
    .filter(({ name }) => name !== '')
    .map((one) => `<tspan fill="${one.colour}">${escaped(one.name)}  </tspan>`);
  return (
    `<text x="${x}" y="16" ${kFont} font-weight="600" fill="${colour}">${escaped(title)}</text>` +
    `<text x="${x}" y="31" ${kFont} xml:space="preserve">${spans.join('')}</text>`
  );
}

function axes(span_s: Span, area: Area, style: SvgStyle): string {
  const { x, y, low, high, plotWidth, plotHeight } = area;
  const bottom = kTop_px + plotHeight;
  const times = ticks(span_s[0], span_s[1], plotWidth / kTickSpace_px);
  const values = ticks(low, high, plotHeight / (kTickSpace_px * 0.6));
  const step = (list: number[]) => (list[1] ?? 1) - (list[0] ?? 0);
  const line = (x1: number, y1: number, x2: number, y2: number) =>
    `<path d="M${x1.toFixed(1)} ${y1.toFixed(1)}L${x2.toFixed(1)} ${y2.toFixed(1)}" stroke="${style.grid}"/>`;
  const text = (tx: number, ty: number, anchor: string, what: string) =>
    `<text x="${tx.toFixed(1)}" y="${ty.toFixed(1)}" text-anchor="${anchor}" ${kFont} fill="${style.text}">${what}</text>`;
  return [
    ...times.map(
      (t) =>
        line(x(t), kTop_px, x(t), bottom) +
        text(x(t), bottom + 14, 'middle', tickText(t, step(times))),
    ),
    ...values.map(
      (value) =>
        line(kLeft_px, y(value), kLeft_px + plotWidth, y(value)) +
        text(kLeft_px - 5, y(value) + 4, 'end', tickText(value, step(values))),
    ),
    text(kLeft_px + plotWidth, bottom + 28, 'end', 'time [s]'),
  ].join('');
}
