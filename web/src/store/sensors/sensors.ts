// Samples of the watched run's sensors: read while they are shown, and again as the run goes on.
import { errorText, isPassing } from '../../connection/rest_error';
import type { RestClient } from '../../connection/rest_client';
import type { SensorCurves } from '../../protocol/sensor_types';
import { isActive } from '../../protocol/rest_types';
import type { Store } from '../state';
import type { Span } from '../playback/time_window';

export interface SensorSamples {
  /** Of this run. */
  run: string;
  sensors: SensorCurves[];
  /** Of all samples [s]; -Infinity without any. */
  newest_s: number;
  /** Increases with every reading. */
  generation: number;
}

export interface SensorTimers {
  now_ms: () => number;
  later: (callback: () => void, delay_ms: number) => void;
}

/** Values of a curve: twice as many as pixels of a wide plot. */
const kPoints = 1200;
const kRefresh_ms = 2000;
/** The server reads the files again each time: it is busy with that for a tenth of the time. */
const kRest = 9;
/** While the plots are being zoomed, only the last span is read. */
const kSettle_ms = 200;
/** Beyond the shown span, so that the curves reach its edges. */
const kMargin = 0.1;

export class Sensors {
  private wanted: { run: string; span_s: Span | null } | null = null;
  private reading = new AbortController();
  private generation = 0;
  /** The last reading was of a run that went on. */
  private wasActive = false;
  /** Number of the latest wish: timers of earlier ones do nothing. */
  private wish = 0;

  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
    private readonly timers: SensorTimers,
  ) {}

  /**
   * Reads the samples of a run and keeps them up to date.
   * @param span_s  by the run's time, of which a part may lie before its beginning; null = the whole flight
   */
  show(run: string, span_s: Span | null): void {
    const { wanted } = this;
    const sameRun = wanted?.run === run;
    const ended = this.wasActive && !this.isActive(run);
    if (sameRun && sameSpan(wanted.span_s, span_s) && !ended) return;
    this.wasActive = false;
    this.wanted = { run, span_s };
    this.wish += 1;
    const { state } = this.store;
    if (state.sensors?.run !== run) {
      state.sensors = null;
      state.sensorError = null;
      this.store.change('sensors');
    }
    this.readLater(sameRun && !ended ? kSettle_ms : 0);
  }

  /** Stops reading. What was read stays. */
  hide(): void {
    this.wanted = null;
    this.wish += 1;
    this.reading.abort();
  }

  private readLater(delay_ms: number): void {
    const { wish } = this;
    const begin = () => {
      if (wish === this.wish) void this.read();
    };
    if (delay_ms === 0) begin();
    else this.timers.later(begin, delay_ms);
  }

  private async read(): Promise<void> {
    const { wanted, wish } = this;
    if (wanted === null) return;
    const active = this.isActive(wanted.run);
    this.wasActive = active;
    this.reading.abort();
    const reading = new AbortController();
    this.reading = reading;
    const begin_ms = this.timers.now_ms();
    const { state } = this.store;
    let again = active;
    try {
      const sensors = await this.rest.sensors(
        wanted.run,
        widened(wanted.span_s),
        kPoints,
        reading.signal,
      );
      if (reading.signal.aborted) return;
      this.generation += 1;
      const newest_s = newestOf(sensors);
      state.sensors = { run: wanted.run, sensors, newest_s, generation: this.generation };
      state.sensorError = null;
    } catch (error) {
      if (reading.signal.aborted) return;
      state.sensorError = errorText(error);
      again ||= isPassing(error);
    }
    this.store.change('sensors');
    const took_ms = this.timers.now_ms() - begin_ms;
    if (again && wish === this.wish) this.readLater(Math.max(kRefresh_ms, kRest * took_ms));
  }

  private isActive(id: string): boolean {
    const { run } = this.store.state;
    return run === null || run.id !== id || isActive(run);
  }
}

function newestOf(sensors: readonly SensorCurves[]): number {
  const ends = sensors.flatMap(({ curves }) => curves.map(({ t_s }) => t_s.at(-1) ?? -Infinity));
  return Math.max(-Infinity, ...ends);
}

function widened(span_s: Span | null): Span | null {
  if (span_s === null) return null;
  const margin_s = kMargin * (span_s[1] - span_s[0]);
  return [Math.max(0, span_s[0] - margin_s), Math.max(0, span_s[1] + margin_s)];
}

function sameSpan(a: Span | null, b: Span | null): boolean {
  return a === b || (a !== null && b !== null && a[0] === b[0] && a[1] === b[1]);
}
