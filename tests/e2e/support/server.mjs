// The real server, started for a test on a free port with its own run folder.
import { spawn } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, rmSync } from 'node:fs';
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

/** The program under test. */
export function programFile() {
  return kProgram;
}

/** A file of the source tree. */
export function sourceFile(file) {
  return path.join(kRoot, file);
}

/** A place for a server's runs and, kept over its restarts, its token. */
export function makeRunsFolder() {
  const base = mkdtempSync(path.join(tmpdir(), 'overfly-e2e-'));
  mkdirSync(path.join(base, 'runs'));
  return {
    folder: path.join(base, 'runs'),
    tokenFile: path.join(base, 'token'),
    remove: () => rmSync(base, { recursive: true, force: true }),
  };
}

/**
 * Resolves when the server has printed its address: `address` as it was printed, for a browser; `url`
 * and `token` for programs.
 */
export async function startServer({
  runs,
  port = 0,
  tokenFile = null,
  viewerTokenFile = null,
  scenarios = path.join(kRoot, 'scenarios'),
  data = [],
  links = [],
  cameras = [],
  sweeps = path.join(path.dirname(runs), 'sweeps'),
  studies = path.join(path.dirname(runs), 'studies'),
  allowCommands = false,
}) {
  const args = ['serve', '--port', String(port), '--runs', runs];
  if (tokenFile !== null) args.push('--token-file', tokenFile);
  if (viewerTokenFile !== null) args.push('--viewer-token-file', viewerTokenFile);
  args.push('--scenarios', scenarios, '--web', kWeb);
  args.push('--uploads', path.join(path.dirname(runs), 'uploads'));
  args.push('--saved-scenarios', path.join(path.dirname(runs), 'saved'));
  args.push('--sweeps', sweeps, '--studies', studies);
  for (const folder of data) args.push('--data', folder);
  for (const link of links) args.push('--allow-link', link);
  for (const camera of cameras) args.push('--allow-camera', camera);
  if (allowCommands) args.push('--allow-commands');
  const child = spawn(kProgram, args, { cwd: kRoot, stdio: ['ignore', 'pipe', 'pipe'] });
  let output = '';
  const exited = new Promise((resolve) => child.on('exit', resolve));
  const address = await new Promise((resolve, reject) => {
    const late = setTimeout(() => {
      // While it runs, `node --test` does not end.
      child.kill('SIGKILL');
      reject(new Error(`no address after ${kStart_ms} ms\n${output}`));
    }, kStart_ms);
    const read = (chunk) => {
      output += chunk;
      const match = /http:\/\/127\.0\.0\.1:\d+\/\?token=\S+/.exec(output);
      if (match === null) return;
      clearTimeout(late);
      resolve(match[0]);
    };
    child.stdout.on('data', read);
    child.stderr.on('data', read);
    child.on('error', reject);
    void exited.then((code) => reject(new Error(`the server ended with ${code}\n${output}`)));
  });
  const { origin, port: bound, searchParams } = new URL(address);
  return {
    address,
    url: origin,
    token: searchParams.get('token'),
    port: Number(bound),
    output: () => output,
    async kill() {
      child.kill('SIGKILL');
      await exited;
    },
    async stop() {
      const late = setTimeout(() => child.kill('SIGKILL'), kStop_ms);
      child.kill('SIGTERM');
      await exited;
      clearTimeout(late);
    },
  };
}

/** Asks the server as a program does, with its token. */
export function callServer({ url, token }, route, options = {}) {
  const headers = { ...options.headers, authorization: `Bearer ${token}` };
  return fetch(`${url}/api/v1${route}`, { ...options, headers });
}

/** Launches the course in real time, with an estimator that does nothing. @return the run's id */
export async function launchCourse(server, overrides) {
  const answer = await callServer(server, '/runs', {
    method: 'POST',
    headers: { 'content-type': 'application/json' },
    body: JSON.stringify({
      scenario: 'course',
      overrides: {
        pacing: 'real_time',
        estimators: [{ name: 'baseline_hold', type: 'baseline_hold' }],
        ...overrides,
      },
    }),
  });
  if (answer.status !== 201) throw new Error(`POST /runs: ${answer.status}`);
  return (await answer.json()).id;
}

/** Reads JSON from the server. */
export async function getJson(server, route) {
  const answer = await callServer(server, route);
  if (!answer.ok) throw new Error(`GET ${route}: ${answer.status}`);
  return answer.json();
}
