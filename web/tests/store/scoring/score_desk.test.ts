import { beforeEach, describe, expect, it } from 'vitest';

import { RestClient } from '../../../src/connection/rest_client';
import { choiceGroups, ScoreDesk, shortName } from '../../../src/store/scoring/score_desk';
import { Store } from '../../../src/store/state';
import { sampleRun } from '../../support/samples';

const evaluation = {
  truth: { name: 'file:d/t.tum', poses: 2, first_s: 0 },
  estimates: [],
};

let store: Store;
let asked: { url: string; body: unknown }[];
let failing: string | null;
let undeletable: boolean;
/** Scores come when these are called. */
let held: (() => void)[] | null;
/** The lists of files come when these are called. */
let heldLists: (() => void)[] | null;
/** Files of the server. */
let files: string[];
let desk: ScoreDesk;

beforeEach(() => {
  store = new Store();
  asked = [];
  failing = null;
  undeletable = false;
  held = null;
  heldLists = null;
  files = ['file:d/a/t.tum'];
  const rest = new RestClient('api', (url, init) => {
    const body: unknown = typeof init?.body === 'string' ? JSON.parse(init.body) : null;
    asked.push({ url, body });
    if (failing !== null && url.includes('evaluations')) {
      const error = { code: 'not_found', message: failing };
      return Promise.resolve(Response.json({ error }, { status: 404 }));
    }
    if (url === 'api/trajectories') {
      const entry = { format: 'TUM', folder: 'd', size_bytes: 9, uploaded: false };
      const trajectories = files.map((name) => ({ name, ...entry }));
      const list = Response.json({ trajectories, complete: true });
      if (heldLists === null) return Promise.resolve(list);
      const wait = heldLists;
      return new Promise((resolve) => wait.push(() => resolve(list)));
    }
    if (url === 'api/logs') {
      return Promise.resolve(
        Response.json({
          logs: [{ name: 'd/f.bin', format: 'DataFlash', uploaded: true }],
          complete: true,
        }),
      );
    }
    if (undeletable && init?.method === 'DELETE') {
      const error = { code: 'forbidden', message: 'it is in use' };
      return Promise.resolve(Response.json({ error }, { status: 409 }));
    }
    if (held === null) return Promise.resolve(Response.json(evaluation));
    const wait = held;
    return new Promise((resolve) => wait.push(() => resolve(Response.json(evaluation))));
  });
  desk = new ScoreDesk(store, rest, (url) => {
    asked.push({ url, body: 'file' });
    const name = url.startsWith('api/logs') ? 'uploads/f.bin' : 'file:uploads/e.txt';
    const text = JSON.stringify({ name });
    return Promise.resolve({ status: 201, text });
  });
});

const evaluations = () =>
  asked.filter(({ url }) => url === 'api/evaluations').map(({ body }) => body);

describe('ScoreDesk', () => {
  it('offers files by folder, the tracks of ended runs, and logs', async () => {
    await desk.open();
    const runs = [sampleRun(), sampleRun({ id: 'r2', status: 'running' })];
    const groups = choiceGroups(store.state.scorePage, runs);
    expect(groups.map(({ title, choices }) => [title, choices.map(({ name }) => name)])).toEqual([
      ['Files in d', ['file:d/a/t.tum']],
      ['Run The course, r1', ['run:r1/truth', 'run:r1/feature']],
      ['Flight logs', ['log:d/f.bin']],
    ]);
  });

  it('scores as soon as there is a truth and an estimate, by every alignment', async () => {
    await desk.chooseTruth('file:d/t.tum');
    expect(evaluations()).toEqual([]);
    await desk.toggle('run:r1/feature');
    const request = { truth: 'file:d/t.tum', estimates: ['run:r1/feature'] };
    expect(evaluations()).toEqual([
      { ...request, alignments: ['all'], find_offsets: true },
      { ...request, alignments: ['init_scale'], points: 6000 },
    ]);
    await desk.chooseAlignment('sim3');
    expect(evaluations().at(-1)).toMatchObject({ alignments: ['sim3'] });
    expect(store.state.scorePage.scores).toMatchObject(evaluation);
  });

  it('keeps within the points that the server computes', async () => {
    await desk.chooseTruth('file:t');
    for (let i = 0; i < 33; i += 1) await desk.toggle(`file:e${i}`);
    expect(store.state.scorePage.estimates).toHaveLength(32);
    expect(store.state.scorePage.error).toContain('32');
    expect(evaluations().at(-1)).toMatchObject({ points: 3125 });
  });

  it('never scores a trajectory against itself', async () => {
    await desk.toggle('file:a');
    await desk.chooseTruth('file:a');
    expect(store.state.scorePage).toMatchObject({ truth: 'file:a', estimates: [] });
    await desk.toggle('file:a');
    expect(store.state.scorePage).toMatchObject({ truth: null, estimates: ['file:a'] });
  });

  it('takes uploads: the first becomes the truth', async () => {
    await desk.send([new File(['0 0 0 0 0 0 0 1'], 'e 1.txt')]);
    expect(asked[0]?.url).toBe('api/trajectories?name=e_1.txt');
    expect(store.state.scorePage).toMatchObject({ truth: 'file:uploads/e.txt', upload: null });
  });

  it('takes flight logs, whose trajectory is scored like a file', async () => {
    await desk.chooseTruth('file:d/t.tum');
    await desk.send([new File(['x'], 'f 1.bin')]);
    expect(asked.map(({ url }) => url)).toContain('api/logs?name=f_1.bin');
    expect(store.state.scorePage.estimates).toEqual(['log:uploads/f.bin']);
    await desk.remove('log:uploads/f.bin');
    expect(asked.map(({ url }) => url)).toContain('api/logs/uploads%2Ff.bin');
    expect(store.state.scorePage.estimates).toEqual([]);
  });

  it('names the file that cannot be uploaded', async () => {
    await desk.send([new File(['0\n1\n'], 'times.txt')]);
    expect(store.state.scorePage.error).toMatch(/^times\.txt: choose the KITTI poses/);
    expect(asked).toEqual([]);
  });

  it('scores what was chosen when the page was closed before the answer', async () => {
    await desk.open();
    await desk.chooseTruth('file:d/t.tum');
    held = [];
    void desk.toggle('file:e');
    desk.close();
    held = null;
    await desk.open();
    expect(evaluations().slice(1)).toMatchObject([
      { estimates: ['file:e'], alignments: ['all'] },
      { estimates: ['file:e'], alignments: ['init_scale'] },
    ]);
    expect(store.state.scorePage).toMatchObject({ scores: evaluation, working: false });
    desk.close();
    await desk.open();
    expect(evaluations()).toHaveLength(3);
  });

  it('keeps the newest lists, whichever answer comes first', async () => {
    heldLists = [];
    const before = desk.readLists();
    files = [];
    const after = desk.readLists();
    const [older, newer] = heldLists;
    newer?.();
    await after;
    older?.();
    await before;
    expect(store.state.scorePage.files?.trajectories).toEqual([]);
  });

  it('says why a file could not be deleted, and keeps it chosen', async () => {
    await desk.chooseTruth('file:d/t.tum');
    await desk.toggle('file:e');
    undeletable = true;
    await desk.remove('file:e');
    expect(store.state.scorePage).toMatchObject({ error: 'it is in use', estimates: ['file:e'] });
  });

  it('says why nothing could be scored', async () => {
    failing = 'no such trajectory';
    await desk.chooseTruth('file:gone');
    await desk.toggle('file:e');
    expect(store.state.scorePage).toMatchObject({ error: failing, scores: null, working: false });
    failing = null;
    await desk.toggle('file:f');
    expect(store.state.scorePage.error).toBeNull();
  });
});

describe('shortName', () => {
  it.each([
    ['file:data/a/b/t.tum', 'b/t.tum'],
    ['run:20260101-x/feature', '20260101-x/feature'],
  ])('of %s', (name, short) => expect(shortName(name)).toBe(short));
});
