// Values as the server sends them.
import type { RunInstant } from '../../src/protocol/messages';
import type { RunPlayback } from '../../src/store/playback/run_playback';
import type { EstimatorStatus, Run } from '../../src/protocol/rest_types';

export function sampleRun(change: Partial<Run> = {}): Run {
  return {
    id: 'r1',
    scenario: 'course',
    title: 'The course',
    status: 'completed',
    created_utc: '2026-01-02T03:04:05Z',
    error: null,
    problem: null,
    duration_ns: 2e9,
    frames: 63,
    frames_total: 63,
    pacing: 'lockstep',
    estimators: ['feature'],
    flight: 'course: 25 m/s, 45 deg/s, 300 m above the ground',
    seed: 1,
    attribution: '',
    texture_limited: false,
    results: [],
    tags: [],
    note: '',
    queue_position: null,
    left_s: null,
    notice: null,
    world_change: null,
    ...change,
  };
}

export function samplePlayback(change: Partial<RunPlayback> = {}): RunPlayback {
  return {
    t_ns: 0,
    frame: 0,
    playing: false,
    live: false,
    speed: 1,
    loop: false,
    range: null,
    begin_ns: 0,
    end_ns: 2e9,
    flying: false,
    alignment: 'init_scale',
    truth: null,
    estimates: {},
    ...change,
  };
}

/** The message `playback` about one run. */
export function playbackMessage(change: Partial<RunPlayback> = {}, run = 'r1') {
  const { frame, alignment, truth, estimates, ...clock } = samplePlayback(change);
  const { t_ns, end_ns } = clock;
  const instant: RunInstant = { t_ns, frame, alignment, truth, estimates, offset_ns: 0, end_ns };
  return { type: 'playback' as const, ...clock, runs: { [run]: instant } };
}

export function sampleStatus(change: Partial<EstimatorStatus> = {}): EstimatorStatus {
  return {
    state: 'TRACKING',
    crash: null,
    answered: 63,
    dropped: 0,
    unanswered: 0,
    hashes_compared: 63,
    hash_mismatches: 0,
    latency_ms: null,
    resources: null,
    ...change,
  };
}
