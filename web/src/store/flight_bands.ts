// Flight modes, mission items and events of a run, from its log.
import type { LogLine } from './run_data';

export interface FlightBand {
  kind: 'mode' | 'mission';
  text: string;
  begin_ns: number;
  /** null: it lasts until the end. */
  end_ns: number | null;
}

export interface FlightMark {
  t_ns: number;
  text: string;
}

/** Updated incrementally: each call reads only the lines added since the last one. */
export class FlightBands {
  readonly bands: FlightBand[] = [];
  readonly marks: FlightMark[] = [];
  private readonly open = new Map<string, FlightBand>();
  private taken = 0;

  update(log: readonly LogLine[]): void {
    for (; this.taken < log.length; this.taken += 1) {
      const line = log[this.taken];
      if (line === undefined) continue;
      if (line.kind === 'event') this.marks.push({ t_ns: line.t_ns, text: line.text });
      else if (line.kind === 'mode' || line.kind === 'mission') this.begin(line.kind, line);
    }
  }

  /** What is in force at a time, and events within `slack_ns`. */
  textsAt(t_ns: number, slack_ns: number): string[] {
    const here = this.bands
      .filter(({ begin_ns, end_ns }) => t_ns >= begin_ns && (end_ns === null || t_ns < end_ns))
      .map(({ text }) => text);
    const near = this.marks.filter((mark) => Math.abs(mark.t_ns - t_ns) <= slack_ns);
    return [...here, ...near.slice(0, kMostMarks).map(({ text }) => text)];
  }

  private begin(kind: 'mode' | 'mission', { t_ns, text }: LogLine): void {
    const last = this.open.get(kind);
    if (last?.text === text) return;
    if (last !== undefined) last.end_ns = t_ns;
    const band = { kind, text, begin_ns: t_ns, end_ns: null };
    this.open.set(kind, band);
    this.bands.push(band);
  }
}

const kMostMarks = 3;
