import { beforeEach, describe, expect, it } from 'vitest';
import { RestClient } from '../../../src/connection/rest_client';
import { Sensors } from '../../../src/store/sensors/sensors';
import { sampleRun } from '../../support/samples';
import { Viewing } from '../../support/viewing';

const kCurve = { name: 'wx_rad_s', t_s: [0.5, 1.5], values: [1, 2] };
const kAnswer = { sensors: [{ sensor: 'imu', samples: 2, curves: [kCurve] }] };

let viewing: Viewing;
let asked: { url: string; signal: AbortSignal }[];
let answer: () => Promise<Response>;
let waiting: { callback: () => void; delay_ms: number }[];
let now_ms: number;
let sensors: Sensors;

/** Lets answers arrive. */
const settle = () => new Promise((resolve) => setTimeout(resolve, 0));

function fire(): void {
  const due = waiting;
  waiting = [];
  for (const { callback } of due) callback();
}

beforeEach(() => {
  viewing = new Viewing();
  viewing.watch();
  asked = [];
  waiting = [];
  now_ms = 0;
  answer = () => Promise.resolve(Response.json(kAnswer));
  const rest = new RestClient('api', (url, init) => {
    asked.push({ url, signal: init?.signal as AbortSignal });
    return answer();
  });
  sensors = new Sensors(viewing.store, rest, {
    now_ms: () => now_ms,
    later: (callback, delay_ms) => waiting.push({ callback, delay_ms }),
  });
});

describe('Sensors', () => {
  it('reads a finished flight once, and a part of it when that is shown', async () => {
    sensors.show('r1', null);
    sensors.show('r1', null);
    await settle();
    expect(asked.map(({ url }) => url)).toEqual(['api/runs/r1/sensors?points=1200']);
    expect(viewing.store.state.sensors).toMatchObject({
      run: 'r1',
      sensors: kAnswer.sensors,
      newest_s: 1.5,
    });
    expect(waiting).toEqual([]);
    sensors.show('r1', [10, 12]);
    sensors.show('r1', [10, 11]);
    fire();
    await settle();
    expect(asked).toHaveLength(2);
    expect(asked[1]?.url).toBe('api/runs/r1/sensors?points=1200&from_s=9.900000&to_s=11.100000');
  });

  it('asks for no time before the run, of which the clock may show some', async () => {
    sensors.show('r1', [-5, -2]);
    await settle();
    expect(asked[0]?.url).toBe('api/runs/r1/sensors?points=1200&from_s=0.000000&to_s=0.000000');
  });

  it('reads again while the flight goes on, more rarely if that takes long', async () => {
    viewing.socket.receive({ type: 'run', run: sampleRun({ status: 'running' }) });
    sensors.show('r1', null);
    await settle();
    expect(waiting.map(({ delay_ms }) => delay_ms)).toEqual([2000]);
    answer = () => {
      now_ms += 700;
      return Promise.resolve(Response.json(kAnswer));
    };
    fire();
    await settle();
    expect(waiting.map(({ delay_ms }) => delay_ms)).toEqual([6300]);
    // The last samples are read at the end.
    viewing.socket.receive({ type: 'run', run: sampleRun() });
    sensors.show('r1', null);
    sensors.show('r1', null);
    fire();
    await settle();
    expect(asked).toHaveLength(3);
    expect(waiting).toEqual([]);
  });

  it('stops when it is hidden, and drops what another run had', async () => {
    viewing.socket.receive({ type: 'run', run: sampleRun({ status: 'running' }) });
    sensors.show('r1', null);
    await settle();
    sensors.hide();
    fire();
    await settle();
    expect(asked).toHaveLength(1);
    expect(viewing.store.state.sensors).not.toBeNull();
    sensors.show('r2', null);
    expect(viewing.store.state.sensors).toBeNull();
    sensors.hide();
    expect(asked[1]?.signal.aborted).toBe(true);
    await settle();
    expect(viewing.store.state.sensors).toBeNull();
  });

  it('says why samples cannot be read', async () => {
    answer = () =>
      Promise.resolve(
        Response.json({ error: { code: 'unreadable', message: 'imu.csv:3' } }, { status: 422 }),
      );
    sensors.show('r1', null);
    await settle();
    expect(viewing.store.state.sensorError).toBe('imu.csv:3');
    expect(waiting).toEqual([]);
  });

  it('reads a finished flight again if the server was away', async () => {
    answer = () => Promise.reject(new TypeError('refused'));
    sensors.show('r1', null);
    await settle();
    expect(viewing.store.state.sensorError).toBe('the server does not answer');
    answer = () => Promise.resolve(Response.json(kAnswer));
    fire();
    await settle();
    expect(viewing.store.state.sensorError).toBeNull();
    expect(viewing.store.state.sensors?.newest_s).toBe(1.5);
    expect(waiting).toEqual([]);
  });
});
