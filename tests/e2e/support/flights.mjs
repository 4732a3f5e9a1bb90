// Flights that a test shows, flown by the program before.
import { execFileSync } from 'node:child_process';
import { linkSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { programFile, sourceFile } from './server.mjs';

/** Overrides of the course: 8 s, of which a blackout loses the estimator. */
export const kBlackout = [
  'duration_s=8',
  'flight.course.leg_length_m=100',
  'camera.width_px=320',
  'camera.height_px=240',
  'camera.rate_hz=16',
  'estimators=[{"name":"feature","type":"feature"}]',
  'faults=[{"kind":"blackout","at_s":4,"duration_s":3}]',
];

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
 * Many run folders that look like one flight: what the list of runs reads of each is its own, the
 * rest is shared.
 * @param change is given the number, the manifest and the metrics, which it may change
 */
export function multiplyFlight(runs, id, count, change) {
  const source = path.join(runs, id);
  const read = (name) => readFileSync(path.join(source, name), 'utf8');
  const [manifest, metrics] = [read('manifest.json'), read('metrics.json')];
  for (let i = 0; i < count; i += 1) {
    const own = { manifest: JSON.parse(manifest), metrics: JSON.parse(metrics) };
    change(i, own);
    const folder = path.join(runs, `20260101-000000-${String(i).padStart(4, '0')}`);
    mkdirSync(folder);
    for (const [name, content] of Object.entries(own)) {
      writeFileSync(path.join(folder, `${name}.json`), JSON.stringify(content));
    }
    const created_utc = new Date(Date.UTC(2026, 0, 1) + i * 1000).toISOString();
    writeFileSync(path.join(folder, 'created.json'), JSON.stringify({ created_utc }));
    for (const name of ['scenario.json', 'timings.json', 'frames.jsonl', 'truth.tum']) {
      linkSync(path.join(source, name), path.join(folder, name));
    }
  }
  rmSync(source, { recursive: true });
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
