// Flights that a test shows, flown by the program before.
import { execFileSync } from 'node:child_process';
import path from 'node:path';
import { programFile, sourceFile } from './server.mjs';

/** Flies the course into a folder of runs. @param fields  "path=value" each */
export function flyCourse(runs, id, fields) {
  flyScenario('course', runs, id, fields);
}

/** As above, another scenario. */
export function flyScenario(name, runs, id, fields) {
  const overrides = fields.flatMap((field) => ['--set', field]);
  const scenario = sourceFile(`scenarios/${name}.json`);
  const out = path.join(runs, id);
  execFileSync(programFile(), ['run', scenario, '--out', out, '--quiet', ...overrides]);
}

/**
 * Two flights with three estimators each and two small cameras, which take a second: one estimator
 * that works, and two whose scale drifts.
 */
export function flyPair(runs) {
  const drifting = (name, drift) => ({ name, type: 'drifting', parameters: { drift } });
  const estimators = [
    drifting('drifts', 0.1),
    drifting('strays', 0.25),
    { name: 'flat', type: 'baseline_homography' },
  ];
  const small = [0, 1].flatMap((i) => [`cameras.${i}.width_px=160`, `cameras.${i}.height_px=120`]);
  const common = ['faults=[]', ...small, `estimators=${JSON.stringify(estimators)}`];
  for (const { id, airspeed_m_s, duration_s } of kPair) {
    const own = [`flight.course.airspeed_m_s=${airspeed_m_s}`, `duration_s=${duration_s}`];
    flyScenario('camera_faults', runs, id, [...common, ...own]);
  }
  return {};
}

export const kPair = [
  { id: '20260101-000001-slow', airspeed_m_s: 18, duration_s: 10 },
  { id: '20260101-000002-fast', airspeed_m_s: 25, duration_s: 8 },
];
