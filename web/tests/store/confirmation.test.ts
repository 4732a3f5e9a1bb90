import { expect, it } from 'vitest';
import { Confirmation } from '../../src/store/confirmation';
import { FakeTimers } from '../support/fake_socket';

it('is given by the second click, unless that comes late', () => {
  const timers = new FakeTimers();
  const shown: boolean[] = [];
  const question = new Confirmation(
    (asked) => shown.push(asked),
    (callback, delay_ms) => timers.set(callback, delay_ms),
  );
  expect(question.click()).toBe(false);
  expect(shown).toEqual([true]);
  timers.fire();
  expect(shown).toEqual([true, false]);
  expect(question.click()).toBe(false);
  expect(question.click()).toBe(true);
  expect(shown).toEqual([true, false, true, false]);
  timers.fire();
  expect(shown).toHaveLength(4);
});
