import { beforeEach, describe, expect, it, vi } from 'vitest';
import { RestClient } from '../../../src/connection/rest_client';
import { SweepClient } from '../../../src/connection/sweep_client';
import { Store } from '../../../src/store/state';
import { formatted, SweepForm } from '../../../src/store/sweeps/sweep_form';

const kDocument = { title: 'Six', axes: [{ path: 'h', values: [1, 2] }] };
const kCost = {
  valid: true,
  message: '',
  faults: [],
  cells: 2,
  estimators: 1,
  estimator_names: ['feature'],
  border_axes: [{ name: 'h', label: 'Height' }],
  flights: 2,
  flight_s: null,
};

let store: Store;
let asked: { call: string; body: unknown }[];
let check: object;
let checkStatus: number;
let start: { status: number; body: object };
let waiting: (() => void)[];
const started = vi.fn(() => Promise.resolve());
let form: SweepForm;

const settle = () => new Promise((resolve) => setTimeout(resolve));
const shown = () => {
  const { form: state } = store.state.sweepPage;
  if (state === null) throw new Error('the form is closed');
  return state;
};

beforeEach(() => {
  store = new Store();
  asked = [];
  waiting = [];
  check = kCost;
  checkStatus = 200;
  start = { status: 201, body: {} };
  started.mockClear();
  const rest = new RestClient('api', (url, init) => {
    const body = typeof init?.body === 'string' ? (JSON.parse(init.body) as unknown) : null;
    asked.push({ call: `${init?.method} ${url}`, body });
    const answer = (json: object, status = 200) => Promise.resolve(Response.json(json, { status }));
    if (url === 'api/sweep-files') {
      const file = { title: '', description: '' };
      return answer({
        files: [
          { name: 'broken', ...file, error: 'axes: must be given' },
          { name: 'quick', ...file, error: null },
        ],
        jobs: { default: 2, most: 4 },
      });
    }
    if (url === 'api/sweep-check') return answer(check, checkStatus);
    if (init?.method === 'POST') return answer(start.body, start.status);
    return answer(kDocument);
  });
  form = new SweepForm(store, new SweepClient(rest), (callback) => waiting.push(callback), started);
});

describe('SweepForm', () => {
  it('checks again while the server checks sweeps of others', async () => {
    checkStatus = 503;
    await form.open();
    await settle();
    expect(shown()).toMatchObject({ checking: true, cost: null, errors: [] });
    checkStatus = 200;
    expect(waiting).toHaveLength(1);
    waiting[0]?.();
    await settle();
    expect(shown()).toMatchObject({ checking: false, cost: kCost });
  });

  it('begins with the first sound file, under a name that is free, and shows the cost', async () => {
    store.state.sweepPage.sweeps = [{ name: 'quick' } as never];
    await form.open();
    await settle();
    expect(shown()).toMatchObject({ file: 'quick', name: 'quick_2', jobs: 2, cost: kCost });
    expect(JSON.parse(shown().text)).toEqual(kDocument);
  });

  it('keeps what is typed while the file is read', async () => {
    const opened = form.open();
    form.setName('mine');
    await opened;
    await settle();
    expect(shown()).toMatchObject({ file: 'quick', name: 'mine' });
    expect(JSON.parse(shown().text)).toEqual(kDocument);
    const again = form.open();
    form.setText('{"a": 1}');
    await again;
    expect(shown()).toMatchObject({ file: null, name: '', text: '{"a": 1}' });
    const chosen = form.chooseFile('quick');
    form.setText('{"a": 2}');
    await chosen;
    expect(shown()).toMatchObject({ file: null, name: 'quick', text: '{"a": 2}' });
  });

  it('starts the search of a border along an axis that the document has', async () => {
    await form.open();
    await settle();
    form.setBorder({ axis: 'h' });
    await form.start();
    const { body } = asked.find(({ call }) => call === 'POST api/sweeps') ?? {};
    expect(body).toMatchObject({ border: { axis: 'h', estimator: 'feature' } });
    await form.open();
    await settle();
    form.setBorder({ axis: 'h' });
    check = { ...kCost, border_axes: [] };
    form.setText('{}');
    waiting.pop()?.();
    await settle();
    expect(shown().border.axis).toBe('');
    asked = [];
    await form.start();
    expect(asked.at(-1)?.body).not.toHaveProperty('border');
  });

  it('checks after a pause in typing, once', async () => {
    await form.open();
    await settle();
    asked = [];
    form.setText('{"a": 1}');
    form.setText('{"a": 2}');
    expect(shown().cost).toBeNull();
    for (const callback of waiting) callback();
    await settle();
    expect(asked).toEqual([{ call: 'POST api/sweep-check', body: { document: { a: 2 } } }]);
  });

  it('shows the faults of the fields, and of text that is no JSON', async () => {
    await form.open();
    await settle();
    check = {
      ...kCost,
      valid: false,
      faults: [{ field: 'axes.0.step', message: 'axes.0.step = 0: must be above 0' }],
    };
    form.setText('{}');
    waiting.pop()?.();
    await settle();
    expect(shown().errors).toEqual([{ field: 'axes.0.step', message: 'must be above 0' }]);
    expect(shown().cost).toBeNull();
    form.setText('{');
    waiting.pop()?.();
    expect(shown().errors[0]?.message).toMatch(/^No JSON/);
    expect(await form.start()).toBe(false);
  });

  it('starts a sweep and shows it', async () => {
    await form.open();
    await settle();
    form.setName('night');
    form.setJobs(9);
    expect(await form.start()).toBe(true);
    expect(asked.at(-1)).toEqual({
      call: 'POST api/sweeps',
      body: { name: 'night', document: kDocument, jobs: 4 },
    });
    expect(store.state.sweepPage.form).toBeNull();
    expect(started).toHaveBeenCalledWith('night');
  });

  it('keeps the text of a sweep that is refused', async () => {
    await form.open();
    await settle();
    const message = 'name = a b: must be 1 to 64 letters';
    start = {
      status: 400,
      body: { error: { code: 'invalid_argument', message, faults: [{ field: 'name', message }] } },
    };
    expect(await form.start()).toBe(false);
    expect(shown()).toMatchObject({
      starting: false,
      errors: [{ field: 'name', message: 'must be 1 to 64 letters' }],
    });
    form.setName('ab');
    expect(shown().errors).toEqual([]);
    expect(started).not.toHaveBeenCalled();
  });

  it('leaves the check of a form that was opened later', async () => {
    const slow = form.openSweep('night');
    const later = form.openSweep('day');
    await Promise.all([later, slow]);
    await settle();
    expect(asked.filter(({ call }) => call === 'POST api/sweep-check')).toHaveLength(1);
    expect(shown()).toMatchObject({ changes: 'day', checking: false, cost: kCost });
  });

  it('extends a sweep under its name', async () => {
    await form.openSweep('night');
    await settle();
    expect(await form.start()).toBe(true);
    expect(asked.at(-1)).toEqual({
      call: 'POST api/sweeps/night/continue',
      body: { document: kDocument, jobs: 2 },
    });
  });
});

describe('formatted', () => {
  it('is the same document, with short parts in one line', () => {
    const document = { a: [1, 2], b: {}, c: [], d: { long: 'x'.repeat(100), e: [{ f: null }] } };
    const text = formatted(document);
    expect(JSON.parse(text)).toEqual(document);
    expect(text).toContain('\n  "a": [ 1, 2 ],\n');
    expect(text).toContain('\n    "e": [ { "f": null } ]\n');
    expect(JSON.parse(formatted({ s: 'two\nlines  of text' }))).toEqual({
      s: 'two\nlines  of text',
    });
  });
});
