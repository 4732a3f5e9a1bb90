import { describe, expect, it } from 'vitest';
import { FlightBands } from '../../src/store/flight_bands';

const line = (t_ns: number, kind: string, text: string) => ({
  t_ns,
  kind,
  text,
  level: 'info',
  source: '',
});

describe('the bands of a flight', () => {
  it('last until the next of their kind, also when lines come one by one', () => {
    const bands = new FlightBands();
    const log = [line(0, 'mode', 'AUTO'), line(0, 'mission', 'mission item 1')];
    bands.update(log);
    expect(bands.bands.map(({ end_ns }) => end_ns)).toEqual([null, null]);
    log.push(line(5, '', 'something else'), line(7, 'mode', 'RTL'), line(8, 'event', 'disarmed'));
    bands.update(log);
    expect(bands.bands).toEqual([
      { kind: 'mode', text: 'AUTO', begin_ns: 0, end_ns: 7 },
      { kind: 'mission', text: 'mission item 1', begin_ns: 0, end_ns: null },
      { kind: 'mode', text: 'RTL', begin_ns: 7, end_ns: null },
    ]);
    expect(bands.textsAt(6, 0)).toEqual(['AUTO', 'mission item 1']);
    expect(bands.textsAt(8, 1)).toEqual(['mission item 1', 'RTL', 'disarmed']);
  });

  it('do not repeat what is in force', () => {
    const bands = new FlightBands();
    bands.update([line(0, 'mode', 'AUTO'), line(3, 'mode', 'AUTO')]);
    expect(bands.bands).toHaveLength(1);
  });
});
