// A simulated aircraft with autopilot, to which a server connects by MAVLink.
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import net from 'node:net';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { programFile, sourceFile } from './server.mjs';

export async function freePort() {
  const server = net.createServer();
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const { port } = server.address();
  await new Promise((resolve) => server.close(resolve));
  return port;
}

/** Starts one that waits at an address, HOST:PORT. */
export async function startVehicle() {
  const address = `127.0.0.1:${await freePort()}`;
  const options = ['--link', `tcp-listen:${address}`, '--airspeed-m-s', '20'];
  const child = spawn(programFile(), ['vehicle', ...options], { stdio: 'ignore' });
  return {
    address,
    /** Arms it and starts a mission; it goes on with it. */
    takeOff() {
      const folder = mkdtempSync(path.join(tmpdir(), 'overfly-vehicle-'));
      const course = JSON.parse(readFileSync(sourceFile('scenarios/course.json'), 'utf8'));
      const mavlink = {
        link: `tcp:${address}`,
        mission_file: sourceFile('scenarios/missions/airfield_pattern.waypoints'),
        arm_and_start: true,
      };
      const scenario = {
        ...course,
        flight: { mavlink },
        duration_s: 25,
        camera: { width_px: 32, height_px: 32, rate_hz: 5 },
        estimators: [],
      };
      const file = path.join(folder, 'take_off.json');
      writeFileSync(file, JSON.stringify(scenario));
      execFileSync(programFile(), ['run', file, '--out', path.join(folder, 'run'), '--quiet']);
      rmSync(folder, { recursive: true });
    },
    stop: () => child.kill(),
  };
}
