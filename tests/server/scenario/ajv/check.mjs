// Asks ajv for its verdict on every mutated scenario and compares it with the program's.
// Usage: node check.mjs ENGINE_TESTS SCHEMA      (exit code 77: ajv is not installed)
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

let Ajv2020;
try {
  ({ default: Ajv2020 } = await import('ajv/dist/2020.js'));
} catch {
  console.log('skipped: ajv is not installed (npm ci --prefix tests/server/scenario/ajv)');
  process.exit(77);
}

const [engineTests, schemaFile] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), 'overfly-verdicts-'));
try {
  const file = join(folder, 'verdicts.json');
  execFileSync(engineTests, ['--gtest_filter=ScenarioMutations.*'], {
    env: { ...process.env, OVERFLY_VERDICTS_FILE: file },
    stdio: 'inherit',
  });
  const cases = JSON.parse(readFileSync(file, 'utf8'));
  const ajv = new Ajv2020({ allErrors: false, strict: true, strictRequired: false });
  const validate = ajv.compile(JSON.parse(readFileSync(schemaFile, 'utf8')));
  let wrong = 0;
  for (const { name, document, valid } of cases) {
    if (validate(document) === valid) continue;
    wrong += 1;
    console.error(`${name}: the program says ${valid}, ajv says ${!valid}`);
    console.error(`  ${JSON.stringify(validate.errors)}`);
  }
  const valid = cases.filter((entry) => entry.valid).length;
  console.log(`${cases.length} scenarios, ${valid} of them valid, ${wrong} verdicts differ`);
  process.exitCode = wrong === 0 && cases.length >= 200 ? 0 : 1;
} finally {
  rmSync(folder, { recursive: true });
}
