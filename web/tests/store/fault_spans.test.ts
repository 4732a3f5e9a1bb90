import { describe, expect, it } from 'vitest';
import { faultMeaning, FaultSpans, kindsOf } from '../../src/store/fault_spans';
import { frameInfo } from '../../src/store/pictures/frame_info';
import { RunData } from '../../src/store/run_data';

function flight(faults: (string[] | null)[]): RunData {
  const data = new RunData();
  const frame = faults.map((_, k) => k);
  data.apply({
    stream: 'truth',
    seq: 0,
    columns: {
      frame,
      t_ns: frame.map((k) => k * 10),
      texels_per_pixel: frame.map(() => 0.3),
      exposure_ns: frame.map((k) => (k === 0 ? 2_500_000 : null)),
      gain: frame.map((k) => (k === 0 ? 1.5 : null)),
      saturated_fraction: frame.map((k) => (k === 0 ? 0.25 : null)),
      late_tiles: frame.map((k) => (k === 0 ? 3 : null)),
      stamp_offset_ns: frame.map((k) => (k === 0 ? -4_000_000 : null)),
      faults,
    },
  });
  return data;
}

describe('FaultSpans', () => {
  const faults = [null, ['dirt'], ['dirt', 'blackout'], ['blackout'], null, ['dirt']];

  it('joins the frames of a fault and keeps those of others apart', () => {
    const spans = new FaultSpans().update(flight(faults));
    expect(spans).toEqual([
      { kind: 'dirt', begin_ns: 10, end_ns: 30, frames: 2 },
      { kind: 'blackout', begin_ns: 20, end_ns: 40, frames: 2 },
      { kind: 'dirt', begin_ns: 50, end_ns: 50, frames: 1 },
    ]);
    expect(kindsOf(spans)).toEqual(['blackout', 'dirt']);
  });

  it('grows with the rows as if they came at once', () => {
    const growing = new FaultSpans();
    const data = new RunData();
    faults.forEach((kinds, k) => {
      data.apply({
        stream: 'truth',
        seq: k,
        columns: { frame: [k], t_ns: [k * 10], ...(kinds === null ? {} : { faults: [kinds] }) },
      });
      growing.update(data);
    });
    expect(growing.spans).toEqual(new FaultSpans().update(flight(faults)));
  });

  it('takes faults of sensors from the log', () => {
    const data = flight([null, null, null, ['dirt']]);
    const spans = new FaultSpans();
    const say = (t_ns: number, text: string, seq: number) => {
      data.apply({
        stream: 'log',
        seq,
        columns: { t_ns: [t_ns], level: ['warning'], text: [text], kind: ['fault'] },
      });
      return spans.update(data);
    };
    say(5, 'dirt begins, for 1 s', 0);
    say(12, 'gps_outage begins, for 0.7 s', 1);
    expect(spans.spans.at(-1)).toEqual({ kind: 'gps_outage', begin_ns: 12, end_ns: 30, frames: 0 });
    say(24, 'gps_outage ends', 2);
    expect(spans.spans.at(-1)).toMatchObject({ kind: 'gps_outage', end_ns: 24 });
    expect(spans.spans).toHaveLength(2);
    expect(faultMeaning('gps_outage').label).toBe('GPS outage');
  });

  it('has a name even for a kind that it does not know', () => {
    expect(faultMeaning('loose_screw').label).toBe('loose screw');
  });
});

describe('frameInfo', () => {
  it('gives every figure with its unit and warns of what spoils the frame', () => {
    const info = frameInfo(flight([['blackout', 'dirt'], null]), 0);
    const texts = info?.figures.map(({ text }) => text);
    expect(texts).toEqual(['2.500 ms', '1.50 ×', '25.0 %', '0.30', '3', '−4.000 ms']);
    expect(info?.figures.filter(({ warn }) => warn).map(({ key }) => key)).toEqual([
      'saturated',
      'texels',
      'late',
      'stamp',
    ]);
    expect(info?.faults).toEqual(['blackout', 'dirt']);
    expect(info?.marks).toEqual(['Blackout']);
  });

  it('says nothing of a sensor that is not there, and of frames without a row', () => {
    const info = frameInfo(flight([['dirt'], null]), 1);
    expect(info?.figures.map(({ text }) => text)).toEqual(['–', '–', '–', '0.30', '0']);
    expect(info?.faults).toEqual([]);
    expect(frameInfo(flight([null]), 5)).toBeNull();
    expect(frameInfo(flight([null]), null)).toBeNull();
  });
});
