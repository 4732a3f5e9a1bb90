// Why a panel shows no picture of a run.
import { isActive } from '../../protocol/rest_types';
import type { Run } from '../../protocol/rest_types';
import type { WatchedRun } from '../watched_run';

/** Why a run has no picture yet, or will have none. */
export function waitingText(watched: WatchedRun | null): string {
  const run = watched?.run ?? null;
  if (watched === null) return 'Choose a run, or launch one.';
  if (run === null) return kWaiting;
  if (run.status === 'queued') return 'The run is queued.';
  if (!isActive(run)) return endedText(run);
  // The first flight over a world has to make the world.
  return run.notice === null ? kWaiting : sentence(run.notice);
}

/** Why the server cannot draw a picture; null = it has reported nothing. */
export function refusalText({ refusals }: WatchedRun, stream: string): string | null {
  const refusal = refusals.get(stream);
  return refusal === undefined ? null : sentence(refusal);
}

const kWaiting = 'Waiting for the first picture';

function endedText({ status, frames }: Run): string {
  if (status === 'failed') return 'The run failed.';
  if (frames > 0) return kWaiting;
  if (status === 'unreadable') return 'The run cannot be read.';
  return `The run was ${status} before its first picture.`;
}

function sentence(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
