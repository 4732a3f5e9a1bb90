import { describe, expect, it } from 'vitest';
import type { EstimatorStatus } from '../../src/protocol/rest_types';
import { needsAttention, saidBy, statusRows } from '../../src/store/estimator_status';
import type { LogLine } from '../../src/store/run_data';
import { sampleRun, sampleStatus } from '../support/samples';

function cellOf(status: EstimatorStatus, column: string) {
  const run = sampleRun({ estimators: ['a'] });
  const cell = statusRows(run, { a: status })[0]?.cells.find((one) => one.column === column);
  if (cell === undefined) throw new Error(`no cell ${column}`);
  return cell;
}

describe('statusRows', () => {
  it('has a row for each estimator of the run, in order, with or without a status', () => {
    const run = sampleRun({ estimators: ['b', 'a'] });
    const rows = statusRows(run, { a: sampleStatus() });
    expect(rows.map(({ name, state }) => [name, state])).toEqual([
      ['b', '–'],
      ['a', 'TRACKING'],
    ]);
    expect(rows[0]?.cells.every(({ text }) => text === '–')).toBe(true);
    expect(statusRows(null, {})).toEqual([]);
  });

  it('gives drops as a share of the frames that came', () => {
    const status = sampleStatus({ answered: 400, dropped: 220, unanswered: 0 });
    expect(cellOf(status, 'dropped').text).toBe('220 (35.5 %)');
    expect(cellOf(sampleStatus({ dropped: 0 }), 'dropped').text).toBe('0');
  });

  it('says whose processor time and memory it shows', () => {
    const own = sampleStatus({
      resources: { cpu_s: 3, cpu_percent: 87.4, peak_memory_mb: 443.2, measured: 'process' },
    });
    expect(cellOf(own, 'cpu')).toMatchObject({
      text: '87',
      hint: 'Of its own process, all threads',
    });
    expect(cellOf(own, 'memory').text).toBe('443');
    const shared = sampleStatus({
      resources: { cpu_s: 3, cpu_percent: 50, peak_memory_mb: null, measured: 'calling_thread' },
    });
    expect(cellOf(shared, 'memory').text).toBe('–');
    expect(cellOf(shared, 'cpu').hint).toContain('thread');
  });

  it('marks images that arrived otherwise than they were sent', () => {
    const sound = sampleStatus({ hashes_compared: 9, hash_mismatches: 0 });
    expect(cellOf(sound, 'hashes')).toMatchObject({ text: 'equal', bad: false });
    const damaged = sampleStatus({ hashes_compared: 9, hash_mismatches: 2 });
    expect(cellOf(damaged, 'hashes')).toMatchObject({ text: '2 differ', bad: true });
    expect(cellOf(sampleStatus({ hashes_compared: 0 }), 'hashes').text).toBe('–');
  });

  it('shows latency where there is any', () => {
    const status = sampleStatus({ latency_ms: { median: 12.34, p95: 20, p99: 31.2, max: 40 } });
    expect(cellOf(status, 'latency').text).toBe('12.3 / 31.2');
    expect(cellOf(sampleStatus({ latency_ms: null }), 'latency').text).toBe('–');
  });
});

describe('needsAttention', () => {
  it('is for crashes and for damaged images', () => {
    expect(needsAttention({ a: sampleStatus() })).toBe(false);
    expect(needsAttention({ a: sampleStatus(), b: sampleStatus({ crash: 'killed' }) })).toBe(true);
    expect(needsAttention({ a: sampleStatus({ hash_mismatches: 1 }) })).toBe(true);
  });
});

describe('saidBy', () => {
  it('keeps the newest lines that estimators said', () => {
    const line = (text: string, source: string): LogLine => ({
      t_ns: 0,
      level: 'info',
      text,
      kind: '',
      source,
    });
    const log = [line('1', 'a'), line('drawn by egl', ''), line('2', 'b'), line('3', 'a')];
    expect(saidBy(log, 2).map(({ text }) => text)).toEqual(['2', '3']);
    expect(saidBy(log, 9).map(({ text }) => text)).toEqual(['1', '2', '3']);
  });
});
