import { afterEach, beforeEach, expect, it, vi } from 'vitest';
import { kTopics, Store } from '../../src/store/state';
import { Launcher } from '../../src/views/launcher';
import type { Context } from '../../src/views/view';
import type { FakeElement } from '../support/fake_document';
import { stubDocument } from '../support/fake_document';

beforeEach(stubDocument);
afterEach(() => vi.unstubAllGlobals());

it('promises a viewer no more of the flight logs than to look at them', () => {
  const store = new Store();
  const launcher = new Launcher({ store } as unknown as Context);
  const root = launcher.root as unknown as FakeElement;
  const hint = () => root.byRole('open-logs').attributes.get('title');
  launcher.update(kTopics);
  expect(hint()).toMatch(/upload them, fly them/);
  store.setAccess('viewer');
  launcher.update(store.take());
  expect(hint()).toBe('Flight logs: look at what they contain');
  store.setAccess('operator');
  launcher.update(store.take());
  expect(hint()).toMatch(/upload them, fly them/);
});
