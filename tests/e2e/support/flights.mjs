// Flights that a test shows, flown by the program before.
import { execFileSync } from 'node:child_process';
import path from 'node:path';
import { programFile, sourceFile } from './server.mjs';

/** Flies the course into a folder of runs. @param fields  "path=value" each */
export function flyCourse(runs, id, fields) {
  const overrides = fields.flatMap((field) => ['--set', field]);
  const scenario = sourceFile('scenarios/course.json');
  const out = path.join(runs, id);
  execFileSync(programFile(), ['run', scenario, '--out', out, '--quiet', ...overrides]);
}
