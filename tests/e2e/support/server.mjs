// The real server, started for a test on a free port with a run folder of its own.
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const kRoot = fileURLToPath(new URL('../../..', import.meta.url));
const kProgram = path.resolve(kRoot, process.env.OVERFLY_BIN ?? 'build/release/overfly');
const kWeb = path.join(kRoot, 'web/dist');
const kStart_ms = 60_000;
const kStop_ms = 20_000;

/** Why the server cannot be started here; false when it can. */
export function serverMissing() {
  if (!existsSync(kProgram)) return `${kProgram} is not built (OVERFLY_BIN names another)`;
  if (!existsSync(path.join(kWeb, 'index.html'))) return 'web/dist is not built';
  return false;
}

/** A file of the source tree. */
export function sourceFile(file) {
  return path.join(kRoot, file);
}

export function makeRunsFolder() {
  const folder = mkdtempSync(path.join(tmpdir(), 'overfly-e2e-'));
  return { folder, remove: () => rmSync(folder, { recursive: true, force: true }) };
}

/** Resolves when the server has told its address. */
export async function startServer({ runs, port = 0, scenarios = path.join(kRoot, 'scenarios') }) {
  const args = ['serve', '--port', String(port), '--runs', runs];
  args.push('--scenarios', scenarios, '--web', kWeb);
  const child = spawn(kProgram, args, { cwd: kRoot, stdio: ['ignore', 'pipe', 'pipe'] });
  let output = '';
  const exited = new Promise((resolve) => child.on('exit', resolve));
  const url = await new Promise((resolve, reject) => {
    const late = setTimeout(
      () => reject(new Error(`no address after ${kStart_ms} ms\n${output}`)),
      kStart_ms,
    );
    const read = (chunk) => {
      output += chunk;
      const match = /http:\/\/127\.0\.0\.1:\d+/.exec(output);
      if (match === null) return;
      clearTimeout(late);
      resolve(match[0]);
    };
    child.stdout.on('data', read);
    child.stderr.on('data', read);
    child.on('error', reject);
    void exited.then((code) => reject(new Error(`the server ended with ${code}\n${output}`)));
  });
  return {
    url,
    port: Number(new URL(url).port),
    output: () => output,
    async stop() {
      const late = setTimeout(() => child.kill('SIGKILL'), kStop_ms);
      child.kill('SIGTERM');
      await exited;
      clearTimeout(late);
    },
  };
}

/** Reads JSON from the server. */
export async function getJson(url, route) {
  const answer = await fetch(`${url}/api/v1${route}`);
  if (!answer.ok) throw new Error(`GET ${route}: ${answer.status}`);
  return answer.json();
}
