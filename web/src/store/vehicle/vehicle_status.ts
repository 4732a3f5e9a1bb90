// What a live vehicle said of itself, as rows of a run: the same live and in playback.
import type { Cell } from '../../protocol/messages';
import { formatNumber } from '../format';

export interface VehicleRow {
  t_ns: number;
  vehicle: string;
  mode: string | null;
  armed: boolean | null;
  battery_v: number | null;
  battery_percent: number | null;
  gps_fix: number | null;
  satellites: number | null;
  messages_per_s: number;
  lost_messages: number;
  lost_percent: number;
  clock_rate: number | null;
  round_trip_ms: number | null;
  gaps: number;
}

export function vehicleRows(columns: Record<string, Cell[]>, count: number): VehicleRow[] {
  const number = (name: string, i: number) => {
    const cell = columns[name]?.[i];
    return typeof cell === 'number' ? cell : null;
  };
  const text = (name: string, i: number) => {
    const cell = columns[name]?.[i];
    return typeof cell === 'string' ? cell : null;
  };
  return Array.from({ length: count }, (_, i) => {
    const armed = columns['armed']?.[i];
    return {
      t_ns: number('t_ns', i) ?? 0,
      vehicle: text('vehicle', i) ?? '',
      mode: text('mode', i),
      armed: typeof armed === 'boolean' ? armed : null,
      battery_v: number('battery_v', i),
      battery_percent: number('battery_percent', i),
      gps_fix: number('gps_fix', i),
      satellites: number('satellites', i),
      messages_per_s: number('messages_per_s', i) ?? 0,
      lost_messages: number('lost_messages', i) ?? 0,
      lost_percent: number('lost_percent', i) ?? 0,
      clock_rate: number('clock_rate', i),
      round_trip_ms: number('round_trip_ms', i),
      gaps: number('gaps', i) ?? 0,
    };
  });
}

const kSilence_ns = 2e9;

/** Rows come twice a second: without one for longer, the vehicle was not heard. */
export function vehicleAt(
  rows: readonly VehicleRow[],
  t_ns: number,
): { row: VehicleRow; connected: boolean } | null {
  let row: VehicleRow | undefined;
  for (const candidate of rows) {
    if (candidate.t_ns > t_ns) break;
    row = candidate;
  }
  return row === undefined ? null : { row, connected: t_ns - row.t_ns <= kSilence_ns };
}

const kFixes = ['no GPS', 'no fix', '2D fix', '3D fix', 'DGPS', 'RTK float', 'RTK fixed'];

/** Lines of the card; what is not known is a dash, so that nothing moves. */
export function vehicleLines(row: VehicleRow): { key: string; label: string; text: string }[] {
  const known = (value: number | null, digits: number, unit: string) =>
    value === null ? '–' : `${formatNumber(value, digits)} ${unit}`;
  const armed = row.armed === null ? '–' : row.armed ? 'armed' : 'disarmed';
  const fix = row.gps_fix === null ? '–' : (kFixes[row.gps_fix] ?? `fix ${row.gps_fix}`);
  const sats = row.satellites === null ? '' : `, ${row.satellites} satellites`;
  const rate = row.clock_rate === null ? '–' : `×${formatNumber(row.clock_rate, 3)}`;
  const trip = row.round_trip_ms === null ? '' : `, ${formatNumber(row.round_trip_ms, 1)} ms`;
  return [
    { key: 'mode', label: 'Mode', text: `${row.mode ?? '–'}, ${armed}` },
    {
      key: 'battery',
      label: 'Battery',
      text: `${known(row.battery_v, 1, 'V')}, ${known(row.battery_percent, 0, '%')}`,
    },
    { key: 'gps', label: 'GPS', text: `${fix}${sats}` },
    {
      key: 'link',
      label: 'Link',
      text: `${formatNumber(row.messages_per_s, 0)} msg/s, ${formatNumber(row.lost_percent, 1)} % lost`,
    },
    { key: 'clock', label: 'Clock', text: `${rate}${trip}` },
    { key: 'gaps', label: 'Gaps', text: String(row.gaps) },
  ];
}
