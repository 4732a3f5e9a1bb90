// Errors of each estimator over repeated flights: box plot, histogram, and the single flights.
import { formatNumber } from '../../store/format';
import type { ErrorAxis } from '../../store/runs/error_axis';
import { notCounted } from '../../store/runs/counted_results';
import { axisTicks, errorAxis, histogram, placeOn } from '../../store/runs/error_axis';
import type { Repeats } from '../../store/runs/repeats';
import { kSameFlight, repeatChoices, repeatedRuns, repeatsOf } from '../../store/runs/repeats';
import { repeatLabels } from '../../store/runs/repeat_labels';
import { repeatsCsv } from '../../store/runs/repeats_csv';
import { svgFile } from '../../store/plots/svg_pen';
import type { State, Topic } from '../../store/state';
import { estimateColour } from '../colours';
import { h, rebuild, setText } from '../dom';
import type { Panel } from '../panel';
import { makePanel } from '../panel';
import { paint } from '../paint';
import type { PlotFile } from '../plots/plot_files';
import { saveMenu } from '../plots/plot_files';
import { drawingContent, svg } from '../svg';
import type { Context, View } from '../view';

const kLeastRow_px = 58;
const kLine_px = 14;
const kBox_px = 18;
const kBars_px = 26;
const kAxis_px = 36;
const kLeft_px = 9;
/** Between the labels and the axis. */
const kGap_px = 14;
const kRight_px = 24;
const kBins = 24;
/** Of a number of the axis. */
const kNumber_px = 38;
const kLeastWidth_px = 60;

/** A row of the picture: an estimator. */
interface Row extends Repeats {
  labels: string[];
  top_px: number;
  height_px: number;
  colour: string;
}

type Place = (error_m: number) => number;

export class RepeatsPanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly choice = h('select', {
    id: 'repeats-choice',
    'aria-label': 'Runs that are compared',
    title: 'Runs whose position RMSE, alignment init_scale, is compared',
  });
  private readonly drawing = h('div', { class: 'repeats' });
  private readonly rest = h('p', { class: 'hint', 'data-role': 'repeats-not-counted' });
  private repeats: readonly Repeats[] = [];

  constructor(private readonly context: Context) {
    this.panel = makePanel('repeats', 'Repeated flights');
    this.panel.tools.append(
      this.choice,
      saveMenu(
        () => this.file(),
        (text) => context.notices.error(text),
      ),
    );
    this.panel.body.append(this.drawing, this.rest);
    this.root = this.panel.root;
    const draw = () => this.draw(context.store.state);
    this.choice.addEventListener('change', draw);
    new ResizeObserver(draw).observe(this.panel.body);
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('lists') || changed.has('run')) this.draw(this.context.store.state);
  }

  private draw(state: State): void {
    const runs = state.runs ?? [];
    const choices = repeatChoices(runs);
    const chosen = this.choice.value || kSameFlight;
    rebuild(this.choice, JSON.stringify(choices), () =>
      choices.map(({ value, label }) => h('option', { value }, label)),
    );
    const still = choices.some(({ value }) => value === chosen);
    this.choice.value = still ? chosen : kSameFlight;
    const compared = repeatedRuns(runs, this.choice.value, state.run);
    const repeats = repeatsOf(compared);
    this.repeats = repeats;
    const width_px = this.panel.body.clientWidth;
    rebuild(this.drawing, JSON.stringify([repeats, width_px, state.run?.estimators]), () =>
      repeats.length === 0 ? [] : [this.picture(repeats, width_px, state.run?.estimators ?? [])],
    );
    const rest = notCounted(compared).map(([status, count]) => `${count} ${status}`);
    setText(this.rest, rest.length === 0 ? '' : `Not counted: ${rest.join(', ')}`);
    this.rest.hidden = rest.length === 0;
    this.panel.showEmpty(repeats.length > 0 ? null : 'None of these runs is completed and scored.');
  }

  private file(): PlotFile | null {
    const drawing = this.drawing.querySelector('svg');
    if (drawing === null) return null;
    const [width, height] = [drawing.width.baseVal.value, drawing.height.baseVal.value];
    return {
      name: 'repeats',
      csv: () => repeatsCsv(this.repeats),
      svg: () => svgFile(width, height, paint('var(--panel)'), drawingContent(drawing)),
    };
  }

  private picture(repeats: readonly Repeats[], most_px: number, named: readonly string[]): Node {
    const axis = errorAxis(repeats.flatMap(({ errors }) => errors.map(({ error_m }) => error_m)));
    const rows = rowsOf(repeats, named);
    const bottom_px = rows.reduce((sum_px, { height_px }) => sum_px + height_px, 0);
    const labels_px = kLeft_px + this.widest_px(rows.flatMap(({ labels }) => labels)) + kGap_px;
    const width_px = Math.max(kLeastWidth_px, most_px - labels_px - kRight_px);
    const x_px = (error_m: number) => labels_px + placeOn(axis, error_m) * width_px;
    return svg(
      'svg',
      {
        width: labels_px + width_px + kRight_px,
        height: bottom_px + kAxis_px,
        role: 'img',
        'aria-label': repeats.map(wordsOf).join('; '),
      },
      ...axisMarks(axis, x_px, bottom_px),
      ...rows.flatMap((row) => this.row(row, axis, x_px)),
    );
  }

  private widest_px(texts: readonly string[]): number {
    const pen = document.createElement('canvas').getContext('2d');
    if (pen === null) return 0;
    // The widest font of them.
    pen.font = `600 ${getComputedStyle(this.drawing).fontSize} system-ui, sans-serif`;
    return Math.ceil(Math.max(...texts.map((text) => pen.measureText(text).width)));
  }

  private row(row: Row, axis: ErrorAxis, x_px: Place): Node[] {
    const { estimator, errors, summary, top_px, colour } = row;
    const middle_px = top_px + 6 + kBox_px / 2;
    const labels = row.labels.map((text, i) =>
      svg(
        'text',
        {
          x: kLeft_px,
          y: top_px + 17 + i * kLine_px,
          class: i === 0 ? 'repeats-name' : 'repeats-note',
        },
        text,
      ),
    );
    if (summary === null) return labels;
    const { least, q1, median, q3, most } = summary;
    const line = (from: number, to: number) =>
      svg('line', { x1: x_px(from), x2: x_px(to), y1: middle_px, y2: middle_px, stroke: colour });
    const box = svg(
      'g',
      { 'data-box': estimator },
      title(wordsOf(row)),
      line(least, q1),
      line(q3, most),
      svg('rect', {
        x: x_px(q1),
        y: middle_px - kBox_px / 2,
        width: Math.max(1, x_px(q3) - x_px(q1)),
        height: kBox_px,
        rx: 2,
        stroke: colour,
        fill: colour,
        'fill-opacity': 0.18,
      }),
      svg('line', {
        x1: x_px(median),
        x2: x_px(median),
        y1: middle_px - kBox_px / 2,
        y2: middle_px + kBox_px / 2,
        stroke: colour,
        'stroke-width': 2.5,
      }),
    );
    const flights = errors.map(({ run, error_m }) => this.flight(run, error_m, x_px, middle_px));
    return [
      ...labels,
      ...bars(
        errors.map(({ error_m }) => error_m),
        axis,
        top_px + row.height_px - 4,
        colour,
        x_px,
      ),
      box,
      ...flights,
    ];
  }

  /** A single flight; a click shows it. */
  private flight(run: string, error_m: number, x_px: Place, y_px: number): Node {
    const dot = svg(
      'circle',
      { cx: x_px(error_m), cy: y_px, r: 3.5, class: 'repeats-flight', 'data-flight': run },
      title(`${run}: ${formatNumber(error_m, 3)} m`),
    );
    dot.addEventListener('click', () => this.context.session.selectRun(run));
    return dot;
  }
}

/** Estimators of the main run have their colour in the plots, others the next ones. */
function coloursOf(repeats: readonly Repeats[], named: readonly string[]): string[] {
  let next = named.length;
  return repeats.map(({ estimator }) => {
    const index = named.indexOf(estimator);
    return estimateColour(index >= 0 ? index : next++);
  });
}

/** One below the other, each as high as its labels. */
function rowsOf(repeats: readonly Repeats[], named: readonly string[]): Row[] {
  const colours = coloursOf(repeats, named);
  let next_px = 0;
  return repeats.map((one, i) => {
    const labels = repeatLabels(one);
    const top_px = next_px;
    const height_px = Math.max(kLeastRow_px, kLine_px * (labels.length + 1));
    next_px += height_px;
    return { ...one, labels, top_px, height_px, colour: colours[i] ?? '' };
  });
}

function bars(
  errors_m: readonly number[],
  axis: ErrorAxis,
  bottom_px: number,
  colour: string,
  x_px: Place,
): Node[] {
  const counts = histogram(axis, errors_m, kBins);
  const most = Math.max(...counts);
  const left_px = x_px(axis.low);
  const step_px = (x_px(axis.high) - left_px) / kBins;
  return counts.flatMap((count, bin) =>
    count === 0
      ? []
      : [
          svg(
            'rect',
            {
              x: left_px + bin * step_px + 0.5,
              y: bottom_px - (kBars_px * count) / most,
              width: Math.max(1, step_px - 1),
              height: (kBars_px * count) / most,
              fill: colour,
              'fill-opacity': 0.45,
            },
            title(`${count} ${count === 1 ? 'flight' : 'flights'}`),
          ),
        ],
  );
}

function axisMarks(axis: ErrorAxis, x_px: Place, bottom_px: number): Node[] {
  const scale = axis.logarithmic ? ', logarithmic' : '';
  const middle_px = (x_px(axis.low) + x_px(axis.high)) / 2;
  return [
    ...axisTicks(axis, (x_px(axis.high) - x_px(axis.low)) / kNumber_px).flatMap((tick) => [
      svg('line', {
        x1: x_px(tick),
        x2: x_px(tick),
        y1: 0,
        y2: bottom_px,
        class: 'repeats-grid',
      }),
      svg(
        'text',
        { x: x_px(tick), y: bottom_px + 13, class: 'repeats-tick' },
        String(Number(tick.toPrecision(6))),
      ),
    ]),
    svg(
      'text',
      { x: middle_px, y: bottom_px + 28, class: 'repeats-tick' },
      `Position RMSE [m]${scale}`,
    ),
  ];
}

function wordsOf({ estimator, errors, summary }: Repeats): string {
  if (summary === null) return `${estimator}: no flight with an error`;
  const { least, q1, median, q3, most } = summary;
  const [a, b, c, d, e] = [least, q1, median, q3, most].map((value) => formatNumber(value, 3));
  return `${estimator}, ${errors.length} flights: median ${c} m, quartiles ${b} and ${d} m, from ${a} to ${e} m`;
}

function title(text: string): SVGElement {
  return svg('title', {}, text);
}
