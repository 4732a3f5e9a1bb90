// Status of the estimators, apart from their poses: one row each.
import type { EstimatorStatus, EstimatorUse, Run } from '../protocol/rest_types';
import { formatNumber, kNothing } from './format';
import type { LogLine } from './run_data';

export interface StatusCell {
  column: string;
  text: string;
  hint: string;
  bad: boolean;
}

export interface StatusRow {
  name: string;
  state: string;
  crash: string | null;
  cells: StatusCell[];
}

export const kStatusColumns: readonly { key: string; label: string; hint: string }[] = [
  { key: 'answered', label: 'Answers', hint: 'Frames that it has answered' },
  { key: 'dropped', label: 'Dropped', hint: 'Frames that came while it was busy' },
  { key: 'unanswered', label: 'Late', hint: 'Frames taken whose pose was not returned in time' },
  { key: 'latency', label: 'Latency ms', hint: 'From a frame to its answer: median / 99 %' },
  { key: 'cpu', label: 'CPU %', hint: 'Of one processor' },
  {
    key: 'memory',
    label: 'Peak MB',
    hint: 'Of its own process, or as reported by a native estimator',
  },
  { key: 'hashes', label: 'Image hash', hint: 'Images that arrived just as they were sent' },
];

const kCpuHints: Readonly<Record<EstimatorUse['measured'], string>> = {
  process: 'Of its own process, all threads',
  own_account: 'Of its threads in the server',
  calling_thread: "Of the server's thread that calls it",
};
const kMemoryHints: Readonly<Record<EstimatorUse['measured'], string>> = {
  process: 'Of its own process',
  own_account: "Peak size of its map's images, points and observations, in the server's memory",
  calling_thread: "It shares the server's memory",
};

export function statusRows(
  run: Run | null,
  statuses: Readonly<Record<string, EstimatorStatus>>,
): StatusRow[] {
  return (run?.estimators ?? []).map((name) => {
    const status = statuses[name];
    if (status === undefined) return { name, state: kNothing, crash: null, cells: emptyCells() };
    return { name, state: status.state, crash: status.crash, cells: cellsOf(status) };
  });
}

/** Whether some estimator has ended, or received images that differ from those sent. */
export function needsAttention(statuses: Readonly<Record<string, EstimatorStatus>>): boolean {
  return Object.values(statuses).some(
    ({ crash, hash_mismatches }) => crash !== null || hash_mismatches > 0,
  );
}

/** The latest lines logged by estimators, in order. */
export function saidBy(log: readonly LogLine[], most: number): LogLine[] {
  const said: LogLine[] = [];
  for (let i = log.length - 1; i >= 0 && said.length < most; i -= 1) {
    const line = log[i];
    if (line !== undefined && line.source !== '') said.push(line);
  }
  return said.reverse();
}

function emptyCells(): StatusCell[] {
  return kStatusColumns.map(({ key, hint }) => ({
    column: key,
    text: kNothing,
    hint,
    bad: false,
  }));
}

function cellsOf(status: EstimatorStatus): StatusCell[] {
  const given = status.answered + status.dropped + status.unanswered;
  const share = given === 0 ? 0 : status.dropped / given;
  const { latency_ms: latency, resources: use } = status;
  const values: Record<string, Omit<StatusCell, 'column'>> = {
    answered: plain(String(status.answered)),
    dropped: {
      text: status.dropped === 0 ? '0' : `${status.dropped} (${formatNumber(share * 100, 1)} %)`,
      hint: 'Frames that came while it was busy',
      bad: false,
    },
    unanswered: { ...plain(String(status.unanswered)), bad: status.unanswered > 0 },
    latency: {
      text:
        latency === null
          ? kNothing
          : `${formatNumber(latency.median, 1)} / ${formatNumber(latency.p99, 1)}`,
      hint:
        latency === null
          ? ''
          : `95 %: ${formatNumber(latency.p95, 1)} ms, longest: ${formatNumber(latency.max, 1)} ms`,
      bad: false,
    },
    cpu: {
      text: formatNumber(use?.cpu_percent, 0),
      hint: use ? kCpuHints[use.measured] : '',
      bad: false,
    },
    memory: {
      text: formatNumber(use?.peak_memory_mb, 0),
      hint: use ? kMemoryHints[use.measured] : '',
      bad: false,
    },
    hashes: hashCell(status),
  };
  return kStatusColumns.map(({ key }) => ({ column: key, ...(values[key] ?? plain(kNothing)) }));
}

function hashCell({
  hashes_compared,
  hash_mismatches,
}: EstimatorStatus): Omit<StatusCell, 'column'> {
  const hint =
    hashes_compared === 0
      ? 'It does not report which images arrived'
      : `${hashes_compared} images compared, ${hash_mismatches} differ`;
  if (hashes_compared === 0) return { text: kNothing, hint, bad: false };
  if (hash_mismatches === 0) return { text: 'equal', hint, bad: false };
  return { text: `${hash_mismatches} differ`, hint, bad: true };
}

function plain(text: string): Omit<StatusCell, 'column'> {
  return { text, hint: '', bad: false };
}
