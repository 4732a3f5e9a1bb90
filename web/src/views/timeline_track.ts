// The bar of the timeline: the recorded span, the estimators' states, the cursor.
import { formatTime } from '../store/format';
import type { Topic } from '../store/state';
import { clockSpan_ns } from '../store/state';
import { faultMeaning, FaultSpans, kindsOf } from '../store/fault_spans';
import { FlightBands } from '../store/flight_bands';
import { bandHue } from '../store/logs/log_bands';
import type { FaultSpan } from '../store/fault_spans';
import { spansOf, stateName, trackStatesAt } from '../store/state_spans';
import { tracksOf } from '../store/tracks';
import { hueOf } from '../store/plots/plot_specs';
import { curveStyle, faultColour } from './colours';
import { h, promptlyPerFrame, rebuild, setAttribute, setText, wholeLabel } from './dom';
import { paint } from './paint';
import { paintStateLane, stateLegend } from './status/state_lanes';
import type { Context } from './view';

const kStripHeight_px = 4;
/** Of all strips: the bar's. */
const kStrips_px = 14;
/** Of a strip; the rest sets it off from the next one. */
const kFilled = 0.75;
/** More do not fit into the tooltip. */
const kMostStates = 8;
/** Minimum width, so that a fault of one frame stays visible. */
const kLeastFault_px = 2;
const kMostFaults = 4;

export class TimelineTrack {
  readonly root: HTMLElement;
  private readonly recorded = h('div', { class: 'recorded' });
  private readonly range = h('div', { class: 'range', 'data-role': 'range', hidden: true });
  private readonly flight = h('div', { class: 'flight-lane', 'data-role': 'flight-lane' });
  private readonly strips = h('canvas', { class: 'strips' });
  private readonly head = h('div', { class: 'head' });
  /** What the plots show if they do not show everything. */
  private readonly plotted = h('div', { class: 'plotted', 'data-role': 'plotted', hidden: true });
  private readonly tip = h('div', { class: 'tip', hidden: true });
  private readonly faults = h('canvas', { class: 'fault-lane' });
  private readonly legend = h('div', { class: 'fault-legend', 'data-role': 'fault-legend' });
  private readonly bar: HTMLElement;
  private spans = new FaultSpans();
  private spansOf = '';
  private bands = new FlightBands();
  private bandsOf = '';
  /** Position dragged to by the mouse, until the server confirms it. */
  private held_ns: number | null = null;

  constructor(private readonly context: Context) {
    this.bar = h(
      'div',
      { class: 'bar' },
      this.recorded,
      this.flight,
      this.strips,
      this.range,
      this.plotted,
      this.head,
    );
    this.root = h(
      'div',
      { class: 'track', role: 'slider', tabindex: 0, 'aria-label': 'Time' },
      this.faults,
      this.bar,
      this.legend,
      this.tip,
    );
    this.scrub();
    new ResizeObserver(() => {
      this.drawStrips();
      this.drawFaults();
    }).observe(this.bar);
  }

  update(changed: ReadonlySet<Topic>): void {
    if (['rows', 'run', 'log', 'theme'].some((topic) => changed.has(topic as Topic))) {
      this.drawStrips();
      this.drawFaults();
    }
    if (['log', 'rows', 'run', 'playback'].some((topic) => changed.has(topic as Topic))) {
      this.drawFlight();
    }
    if (changed.has('playback') || changed.has('run')) this.moveHead();
    if (['plotTime', 'playback', 'run'].some((topic) => changed.has(topic as Topic))) {
      this.markPlotted();
    }
  }

  /** Share of the bar at a time of the clock. */
  private share(t_ns: number): number {
    const [begin_ns, end_ns] = clockSpan_ns(this.context.store.state);
    return Math.min(1, Math.max(0, (t_ns - begin_ns) / (end_ns - begin_ns)));
  }

  private percent(t_ns: number): string {
    return `${(this.share(t_ns) * 100).toFixed(3)}%`;
  }

  private moveHead(): void {
    const { state } = this.context.store;
    const { clock } = state;
    const [begin_ns, end_ns] = clockSpan_ns(state);
    const t_ns = this.held_ns ?? clock?.t_ns ?? 0;
    this.head.style.left = this.percent(t_ns);
    this.head.hidden = clock === null;
    place(this.recorded, this.share(clock?.begin_ns ?? 0), this.share(clock?.end_ns ?? 0));
    const range = clock?.range ?? null;
    this.range.hidden = range === null;
    if (range !== null) place(this.range, this.share(range.begin_ns), this.share(range.end_ns));
    this.root.setAttribute('aria-valuemin', (begin_ns / 1e9).toFixed(3));
    this.root.setAttribute('aria-valuemax', (end_ns / 1e9).toFixed(3));
    this.root.setAttribute('aria-valuenow', (t_ns / 1e9).toFixed(3));
    this.root.setAttribute('aria-valuetext', formatTime(t_ns));
  }

  private markPlotted(): void {
    const { part_s } = this.context.plotTime;
    this.plotted.hidden = part_s === null;
    if (part_s !== null) {
      place(this.plotted, this.share(part_s[0] * 1e9), this.share(part_s[1] * 1e9));
    }
  }

  private drawStrips(): void {
    const tracks = tracksOf(this.context.store.state).filter(({ name }) => name !== '');
    const width = Math.max(1, Math.round(this.bar.clientWidth * window.devicePixelRatio));
    const lane_px = Math.min(kStripHeight_px, kStrips_px / Math.max(1, tracks.length));
    const height_px = Math.max(1, tracks.length * lane_px);
    const lane = lane_px * window.devicePixelRatio;
    this.strips.style.height = `${height_px}px`;
    this.strips.width = width;
    this.strips.height = Math.ceil(height_px * window.devicePixelRatio);
    const pen = this.strips.getContext('2d');
    if (pen === null) return;
    const [begin_ns, end_ns] = clockSpan_ns(this.context.store.state);
    tracks.forEach((track, i) => {
      const { offset_ns } = track.run;
      const xOf = (t_ns: number) => ((t_ns + offset_ns - begin_ns) / (end_ns - begin_ns)) * width;
      const box = { left: 0, right: width, top: i * lane, height: lane * kFilled };
      paintStateLane(pen, spansOf(track), curveStyle(hueOf(track)).colour, xOf, box);
    });
  }

  /** Modes fill the bar, mission items are a line along its top, events are ticks above it. */
  private drawFlight(): void {
    const { state } = this.context.store;
    const { runId, run, main, data, offset_ns } = state;
    const key = `${String(runId)}/${data.generation}`;
    if (this.bandsOf !== key) {
      this.bandsOf = key;
      this.bands = new FlightBands();
    }
    this.bands.update(data.log);
    const { bands, marks } = this.bands;
    const [, clockEnd_ns] = clockSpan_ns(state);
    // The future of a running flight is not known.
    const now_ns =
      run?.status === 'running' ? (main?.instant?.end_ns ?? 0) : clockEnd_ns - offset_ns;
    const percent = (t_ns: number) => this.share(t_ns + offset_ns) * 100;
    const drawn = [key, bands.length, marks.length, percent(0), percent(1e9), now_ns].join(' ');
    rebuild(this.flight, drawn, () => [
      ...bands.map(({ kind, text, begin_ns, end_ns }, i) => {
        const width = Math.max(0, percent(end_ns ?? now_ns) - percent(begin_ns));
        const place = `left:${percent(begin_ns).toFixed(3)}%;width:${width.toFixed(3)}%;`;
        const colour =
          kind === 'mode'
            ? `background:hsl(${bandHue(text)}, 42%, 32%)`
            : `opacity:${i % 2 === 0 ? 0.9 : 0.45}`;
        return h(
          'span',
          { class: `flight-${kind}`, style: place + colour, [`data-${kind}`]: text },
          kind === 'mode' ? wholeLabel(text) : null,
        );
      }),
      ...marks.map(({ t_ns }) =>
        h('i', { class: 'flight-mark', style: `left:${percent(t_ns).toFixed(3)}%` }),
      ),
    ]);
  }

  /** Time of the clock of a few pixels of the bar. */
  private slack_ns(): number {
    const [begin_ns, end_ns] = clockSpan_ns(this.context.store.state);
    return (kLeastFault_px / Math.max(1, this.bar.clientWidth)) * (end_ns - begin_ns);
  }

  /** The tooltip's text about the flight at a time. */
  private flightText(t_ns: number): string {
    const slack_ns = this.slack_ns();
    const texts = this.bands.textsAt(t_ns, slack_ns);
    return texts.length === 0 ? '' : ` · ${texts.join(' · ')}`;
  }

  /** The tooltip's lines about the estimators at a time of the clock: name, state, from when to when. */
  private stateText(t_ns: number): string {
    const states = trackStatesAt(this.context.store.state, t_ns);
    const unusual = states.filter(({ state }) => state !== 'TRACKING');
    const shown = states.length <= kMostStates ? states : unusual.slice(0, kMostStates);
    const lines = shown.map(
      ({ track, state, begin_ns, end_ns }) =>
        `\n${track.label}: ${stateName(state)} ${formatTime(begin_ns)} – ${formatTime(end_ns)}`,
    );
    const left = states.length - shown.length;
    return lines.join('') + (left === 0 ? '' : `\n${left} more`);
  }

  /** One lane for all faults; if several are active, the later kinds are drawn below. */
  private drawFaults(): void {
    const { runId, data } = this.context.store.state;
    const key = `${String(runId)}/${data.generation}`;
    if (this.spansOf !== key) {
      this.spansOf = key;
      this.spans = new FaultSpans();
    }
    const spans = this.spans.update(data);
    const kinds = kindsOf(spans);
    this.faults.width = Math.max(1, Math.round(this.bar.clientWidth * window.devicePixelRatio));
    this.faults.height = Math.max(
      1,
      Math.round(this.faults.clientHeight * window.devicePixelRatio),
    );
    const pen = this.faults.getContext('2d');
    if (pen !== null) this.paintSpans(pen, spans, kinds);
    setAttribute(this.root, 'data-faults', kinds.length === 0 ? null : kinds.join(' '));
    const tracks = tracksOf(this.context.store.state).filter(({ name }) => name !== '');
    const states = new Set(tracks.flatMap((track) => spansOf(track).map(({ state }) => state)));
    rebuild(this.legend, [...states, '/', ...kinds].join(' '), () => [
      ...(states.size === 0 ? [] : stateLegend(states)),
      ...kinds.map(legendEntry),
    ]);
  }

  private paintSpans(
    pen: CanvasRenderingContext2D,
    spans: readonly FaultSpan[],
    kinds: readonly string[],
  ): void {
    const { offset_ns } = this.context.store.state;
    const { width, height } = pen.canvas;
    const lane = height / kinds.length;
    const least = kLeastFault_px * window.devicePixelRatio;
    for (const { kind, begin_ns, end_ns } of spans) {
      const x = this.share(begin_ns + offset_ns) * width;
      const length = Math.max(least, this.share(end_ns + offset_ns) * width - x);
      pen.fillStyle = paint(faultColour(kind));
      pen.fillRect(x, kinds.indexOf(kind) * lane, length, Math.max(1, lane));
    }
  }

  /** The tooltip's lines about the faults at a time of the clock. */
  private faultText(clock_ns: number): string {
    const { offset_ns } = this.context.store.state;
    const t_ns = clock_ns - offset_ns;
    const slack_ns = this.slack_ns();
    const here = this.spans.spans.filter(
      ({ begin_ns, end_ns }) => t_ns >= begin_ns - slack_ns && t_ns <= end_ns + slack_ns,
    );
    const lines = here.slice(0, kMostFaults).map(({ kind, begin_ns, end_ns, frames }) => {
      const { label, hint } = faultMeaning(kind);
      const when = `${formatTime(begin_ns + offset_ns)} to ${formatTime(end_ns + offset_ns)}`;
      const count = frames === 0 ? '' : `, ${frames} frame${frames === 1 ? '' : 's'}`;
      return `${label}, ${when}${count}: ${hint}`;
    });
    if (here.length > kMostFaults) lines.push(`and ${here.length - kMostFaults} more`);
    return lines.map((line) => `\n${line}`).join('');
  }

  private timeAt(event: PointerEvent): number {
    const box = this.bar.getBoundingClientRect();
    const share = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
    const [begin_ns, end_ns] = clockSpan_ns(this.context.store.state);
    return begin_ns + share * (end_ns - begin_ns);
  }

  private scrub(): void {
    const seek = promptlyPerFrame((t_ns: number) => this.context.player.seekTime(t_ns));
    const hold = (event: PointerEvent) => {
      const { begin_ns = 0, end_ns = 0 } = this.context.store.state.clock ?? {};
      this.held_ns = Math.min(Math.max(this.timeAt(event), begin_ns), end_ns);
      this.moveHead();
      seek(this.held_ns);
    };
    this.root.addEventListener('pointerdown', (event) => {
      if (event.button !== 0 || this.context.store.state.clock === null) return;
      this.root.setPointerCapture(event.pointerId);
      hold(event);
    });
    this.root.addEventListener('pointermove', (event) => {
      if (this.root.hasPointerCapture(event.pointerId)) hold(event);
      this.tip.hidden = false;
      this.tip.style.left = `${event.clientX - this.root.getBoundingClientRect().left}px`;
      const t_ns = this.timeAt(event);
      const run_ns = t_ns - this.context.store.state.offset_ns;
      setText(
        this.tip,
        formatTime(t_ns) + this.flightText(run_ns) + this.faultText(t_ns) + this.stateText(t_ns),
      );
    });
    this.root.addEventListener('pointerleave', () => {
      this.tip.hidden = true;
    });
    const release = () => {
      this.held_ns = null;
    };
    this.root.addEventListener('pointerup', release);
    this.root.addEventListener('pointercancel', release);
  }
}

/** Spans two shares of the bar. */
function place(element: HTMLElement, begin: number, end: number): void {
  element.style.left = `${(begin * 100).toFixed(3)}%`;
  element.style.width = `${((end - begin) * 100).toFixed(3)}%`;
}

function legendEntry(kind: string): HTMLElement {
  const { label, hint } = faultMeaning(kind);
  return h(
    'span',
    { title: hint, 'data-fault-kind': kind },
    h('i', { style: `background:${faultColour(kind)}` }),
    label,
  );
}
