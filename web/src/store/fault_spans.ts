// Faults of the scenario as spans of time, with an explanation of each kind.
import type { LogLine, RunData } from './run_data';

export interface FaultSpan {
  kind: string;
  begin_ns: number;
  /** Stamp of the first frame after it; of the last frame if the fault has not ended. */
  end_ns: number;
  /** Images in it; 0 for a fault that concerns none. */
  frames: number;
}

interface FaultMeaning {
  label: string;
  /** Shown over the camera's picture if it differs from what the estimators received. */
  mark: string | null;
  hint: string;
}

const kMeanings: Readonly<Record<string, FaultMeaning>> = {
  dropped_frames: {
    label: 'Dropped frames',
    mark: 'Frame dropped',
    hint: 'the estimators never get these images',
  },
  frozen_frame: {
    label: 'Frozen frame',
    mark: 'Image frozen',
    hint: 'the last image repeated, with new time stamps',
  },
  blackout: { label: 'Blackout', mark: 'Blackout', hint: 'no light reaches the sensor' },
  saturation_burst: {
    label: 'Saturation burst',
    mark: null,
    hint: 'light on the lens: a flash, or the sun',
  },
  dirt: { label: 'Dirt', mark: null, hint: 'specks on the lens' },
  water_drop: { label: 'Water drop', mark: null, hint: 'drops on the lens' },
  stamp_jitter: {
    label: 'Stamp jitter',
    mark: null,
    hint: 'random errors in the time stamps given to the estimators',
  },
  stamp_offset: {
    label: 'Stamp offset',
    mark: null,
    hint: 'a constant error in the time stamps given to the estimators',
  },
  gps_outage: { label: 'GPS outage', mark: null, hint: 'the receiver has no fix' },
};

export function faultMeaning(kind: string): FaultMeaning {
  return kMeanings[kind] ?? { label: kind.replaceAll('_', ' '), mark: null, hint: '' };
}

/** Kinds in the order in which the timeline stacks and colours them. */
export const kFaultKinds: readonly string[] = Object.keys(kMeanings);

/** Faults of sensors: no frame has them, only the lines of the log where they begin and end. */
const kLogged = /^(gps_outage) (begins|ends)/;

/** Updated incrementally: each call reads only the rows added since the last one. */
export class FaultSpans {
  readonly spans: FaultSpan[] = [];
  private readonly open = new Map<string, FaultSpan>();
  private readonly openInLog = new Map<string, FaultSpan>();
  private taken = 0;
  private takenLines = 0;

  update({ truth, faults, log }: RunData): readonly FaultSpan[] {
    const stamps = truth.column('t_ns');
    for (; this.taken < stamps.length; this.taken += 1) {
      const t_ns = stamps[this.taken] ?? 0;
      const now = faults[this.taken] ?? [];
      for (const [kind, span] of this.open) {
        span.end_ns = t_ns;
        if (!now.includes(kind)) this.open.delete(kind);
      }
      for (const kind of new Set(now)) this.go(kind, t_ns);
    }
    for (; this.takenLines < log.length; this.takenLines += 1) {
      const line = log[this.takenLines];
      if (line?.kind === 'fault') this.takeLine(line);
    }
    const last_ns = stamps[stamps.length - 1] ?? 0;
    for (const span of this.openInLog.values()) span.end_ns = Math.max(span.begin_ns, last_ns);
    return this.spans;
  }

  private takeLine({ t_ns, text }: LogLine): void {
    const [, kind, what] = kLogged.exec(text) ?? [];
    if (kind === undefined) return;
    const open = this.openInLog.get(kind);
    if (what === 'ends') {
      if (open !== undefined) open.end_ns = t_ns;
      this.openInLog.delete(kind);
    } else if (open === undefined) {
      const span = { kind, begin_ns: t_ns, end_ns: t_ns, frames: 0 };
      this.openInLog.set(kind, span);
      this.spans.push(span);
    }
  }

  private go(kind: string, t_ns: number): void {
    let span = this.open.get(kind);
    if (span === undefined) {
      span = { kind, begin_ns: t_ns, end_ns: t_ns, frames: 0 };
      this.open.set(kind, span);
      this.spans.push(span);
    }
    span.frames += 1;
  }
}

/** Kinds that occur in the run, in display order; unknown ones last. */
export function kindsOf(spans: readonly FaultSpan[]): string[] {
  const place = (kind: string) => {
    const index = kFaultKinds.indexOf(kind);
    return index < 0 ? kFaultKinds.length : index;
  };
  return [...new Set(spans.map(({ kind }) => kind))].sort((a, b) => place(a) - place(b));
}
