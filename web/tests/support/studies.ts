// Studies as a server describes them.
import type { Run } from '../../src/protocol/rest_types';
import type {
  Explanation,
  HuntedFlight,
  Reflight,
  StudyEntry,
  StudyState,
} from '../../src/protocol/study_types';

export function studyEntry(
  name: string,
  state: StudyState,
  fields: Partial<StudyEntry> = {},
): StudyEntry {
  return {
    name,
    kind: 'explain',
    title: `Title of ${name}`,
    subject: 'run-1',
    estimator: 'feature',
    created_utc: '2026-01-02T03:04:05Z',
    ended_utc: null,
    state,
    cancelling: false,
    position: null,
    problem: null,
    progress: null,
    ...fields,
  };
}

/** A completed run. @param outcomes  estimator to outcome */
export function scoredRun(id: string, outcomes: Record<string, string>): Run {
  const results = Object.entries(outcomes).map(([estimator, outcome]) => ({
    estimator,
    outcome,
    position_rmse_m: null,
    position_rmse_percent: null,
  }));
  return { id, title: `Flight ${id}`, status: 'completed', results } as unknown as Run;
}

export function reflight(fields: Partial<Reflight> = {}): Reflight {
  return {
    name: 'as it was',
    changes: [],
    seed: 1,
    from_s: 2,
    to_s: 12,
    run: 'study.0123456789abcdef0123',
    survived: false,
    outcome: 'LOST',
    outcome_time_s: 6,
    initialised_at_s: 1,
    coverage: 0.5,
    texels_per_pixel_median: 1,
    error: null,
    ...fields,
  };
}

export function explanation(fields: Partial<Explanation> = {}): Explanation {
  return {
    run: 'run-1',
    estimator: 'feature',
    outcome: 'LOST',
    outcome_time_s: 8,
    reproduced: true,
    reproduced_with_other_seed: true,
    from_s: 2,
    to_s: 12,
    sufficient: [],
    necessary: [],
    together: [],
    pair: [],
    margin: null,
    data_limited: false,
    data_reason: '',
    sentences: [],
    flights: [],
    untried: [],
    words: { blur: 'the blur of the images', noise: 'the noise of the sensor' },
    ...fields,
  };
}

export function hunted(margin: number, fields: Partial<HuntedFlight> = {}): HuntedFlight {
  return {
    values: {},
    repeat: 0,
    seed: 1,
    run: 'study.0123456789abcdef0123',
    outcome: margin < 0 ? 'LOST' : 'COMPLETED',
    margin,
    failed: margin < 0,
    failure: margin < 0 ? 'LOST at 3.2 s' : '',
    factors: {},
    ...fields,
  };
}
