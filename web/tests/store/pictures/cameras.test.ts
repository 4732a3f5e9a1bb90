import { beforeEach, describe, expect, it } from 'vitest';
import { RestClient } from '../../../src/connection/rest_client';
import { Cameras } from '../../../src/store/pictures/cameras';
import { Viewing } from '../../support/viewing';

let viewing: Viewing;
let cameras: Cameras;
let waiting: (() => void)[];
let asked: number;
let answer: () => Promise<Response>;
const settle = () => new Promise((resolve) => setTimeout(resolve, 0));

beforeEach(() => {
  viewing = new Viewing();
  viewing.watch();
  waiting = [];
  asked = 0;
  const rest = new RestClient('api', () => {
    asked += 1;
    return answer();
  });
  cameras = new Cameras(viewing.store, rest, (callback) => waiting.push(callback));
});

const refusal = (status: number) =>
  Promise.resolve(Response.json({ error: { code: 'no', message: 'no' } }, { status }));

describe('Cameras', () => {
  it.each([
    ['does not answer', () => Promise.reject(new TypeError('refused'))],
    ['is busy', () => refusal(503)],
  ])('are read later if the server %s', async (_, failure) => {
    answer = failure;
    await cameras.refresh();
    await cameras.refresh();
    expect(asked, 'not with every change of the screen').toBe(1);
    answer = () => Promise.resolve(Response.json({ cameras: [{ name: 'down' }] }));
    for (const callback of waiting.splice(0)) callback();
    await settle();
    expect(viewing.store.state.cameras).toEqual([{ name: 'down' }]);
    await cameras.refresh();
    expect(asked).toBe(2);
  });

  it('are asked for once of a run without a manifest', async () => {
    answer = () => refusal(404);
    await cameras.refresh();
    await cameras.refresh();
    expect(asked).toBe(1);
    expect(waiting).toEqual([]);
  });
});
