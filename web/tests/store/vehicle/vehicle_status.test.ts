import { describe, expect, it } from 'vitest';
import { RunData } from '../../../src/store/run_data';
import { vehicleAt, vehicleLines } from '../../../src/store/vehicle/vehicle_status';

const columns = {
  t_ns: [0, 5e8],
  vehicle: ['1.1', '1.1'],
  mode: ['AUTO', null],
  armed: [true, null],
  battery_v: [12.34, null],
  battery_percent: [87, null],
  gps_fix: [3, null],
  satellites: [10, null],
  messages_per_s: [51.6, 0],
  lost_messages: [2, 2],
  lost_percent: [0.04, 0.04],
  clock_rate: [1.0004, null],
  round_trip_ms: [3.2, null],
  gaps: [1, 1],
};

describe('the state of a live vehicle', () => {
  it('comes as rows that are counted for resuming', () => {
    const data = new RunData();
    expect(data.apply({ stream: 'vehicle', seq: 0, columns })).toBe(true);
    expect(data.resume()).toEqual({ vehicle: 2 });
  });

  it('is that of the cursor, and ends when no rows follow', () => {
    const data = new RunData();
    data.apply({ stream: 'vehicle', seq: 0, columns });
    expect(vehicleAt([], 0)).toBeNull();
    expect(vehicleAt(data.vehicle, 4e8)?.row.mode).toBe('AUTO');
    expect(vehicleAt(data.vehicle, 6e8)?.connected).toBe(true);
    expect(vehicleAt(data.vehicle, 9e9)?.connected).toBe(false);
  });

  it('has units, and dashes for what is not known', () => {
    const data = new RunData();
    data.apply({ stream: 'vehicle', seq: 0, columns });
    const texts = data.vehicle.map((row) => vehicleLines(row).map(({ text }) => text));
    expect(texts[0]).toEqual([
      'AUTO, armed',
      '12.3 V, 87 %',
      '3D fix, 10 satellites',
      '52 msg/s, 0.0 % lost',
      '×1.000, 3.2 ms',
      '1',
    ]);
    expect(texts[1]).toEqual(['–, –', '–, –', '–', '0 msg/s, 0.0 % lost', '–', '1']);
  });
});
