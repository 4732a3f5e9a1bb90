import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import type { SweepEntry, SweepState } from '../../../src/protocol/sweep_types';
import { progressTexts, SweepHead } from '../../../src/views/sweeps/sweep_head';
import type { Context } from '../../../src/views/view';
import type { FakeElement } from '../../support/fake_document';
import { stubDocument } from '../../support/fake_document';

const begun: SweepState = {
  sweep: {
    name: 's',
    title: '',
    estimators: ['feature'],
    repeats: 1,
    axes: [],
    flying: true,
    here: 'flying',
    envelope: null,
    problem: null,
    progress: { passed: 0, most: 4, flown: 0, failed: 0, spent_s: 0, left_s: null },
    changed_utc: '2026-01-02T03:04:05Z',
  },
  envelope: null,
  table: null,
};

it('has a last result only once there is one', () => {
  expect(progressTexts(begun)).toEqual(['0 of 4 flights', 'no flight is over yet']);
  const { sweep } = begun;
  const progress = { passed: 1, most: 4, flown: 1, failed: 1, spent_s: 2, left_s: 6 };
  const table = { conventions: {}, failed: 1, unreadable: 0 } as unknown as SweepState['table'];
  const texts = progressTexts({ ...begun, sweep: { ...sweep, progress }, table });
  expect(texts[0]).toBe('1 of 4 flights');
  expect(texts).toContain('1 flight failed');
  expect(texts.at(-1)).toMatch(/^last result 2026-01-0/);
});

describe('what is asked twice', () => {
  /** What the head has asked the server for. */
  let done: string[];
  let timers: (() => void)[];
  let head: SweepHead;

  beforeEach(() => {
    stubDocument();
    timers = [];
    vi.stubGlobal('window', { setTimeout: (callback: () => void) => timers.push(callback) });
    done = [];
    head = new SweepHead({
      sweeps: {
        cancel: (name: string) => done.push(`cancel ${name}`),
        remove: (name: string) => done.push(`remove ${name}`),
      },
    } as unknown as Context);
  });
  afterEach(() => vi.unstubAllGlobals());

  function draw(change: Partial<SweepEntry> = {}): void {
    const sweep = { ...begun.sweep, ...change };
    head.draw({ ...begun, sweep }, [sweep]);
  }
  const button = (role: string) => (head.root as unknown as FakeElement).byRole(role);
  const ended = { flying: false, here: null };

  it('is the cancelling of a sweep', () => {
    draw();
    button('cancel-sweep').click();
    expect(button('cancel-sweep').textContent).toBe('Cancel the sweep?');
    draw();
    button('cancel-sweep').click();
    expect(done).toEqual(['cancel s']);
    expect(button('cancel-sweep').textContent).toBe('Cancel');
  });

  it('is the deletion of a sweep, for some seconds', () => {
    draw(ended);
    button('delete-sweep').click();
    for (const callback of timers.splice(0)) callback();
    button('delete-sweep').click();
    expect(done).toEqual([]);
    button('delete-sweep').click();
    expect(done).toEqual(['remove s']);
  });

  it('is not answered by a click on what has come in its place', () => {
    draw();
    button('cancel-sweep').click();
    draw(ended);
    expect(button('delete-sweep').textContent).toBe('Delete');
    button('delete-sweep').click();
    expect(done).toEqual([]);
    // The time of the question before does not end this one.
    timers.shift()?.();
    expect(button('delete-sweep').textContent).toBe('Delete the sweep?');
  });

  it('names the flights that are lost', () => {
    const title = (passed: number) => {
      const rest = { most: 4, flown: passed, failed: 0, spent_s: 1, left_s: null };
      draw({ ...ended, progress: { passed, ...rest } });
      return button('delete-sweep').attributes.get('title');
    };
    expect(title(1)).toBe('Delete the sweep and its 1 flight');
    expect(title(2)).toBe('Delete the sweep and its 2 flights');
  });
});
