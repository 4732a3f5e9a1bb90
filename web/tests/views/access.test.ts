import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import kSheet from '../../src/styles/access.css?raw';
import { StreamClient } from '../../src/connection/stream_client';
import type { Access } from '../../src/protocol/messages';
import { Notices } from '../../src/store/notices';
import { Store } from '../../src/store/state';
import {
  guardChanges,
  servedAccess,
  showAccess,
  viewerNote,
  wordsFor,
} from '../../src/views/access';
import { FakeElement, stubDocument } from '../support/fake_document';
import { FakeSocket, FakeTimers } from '../support/fake_socket';
import { unwatchedSession } from '../support/viewing';

/** An element of the page, or of a part of it. */
class Place {
  constructor(private readonly marked: boolean) {}
  closest(selector: string): object | null {
    return this.marked && selector === '[data-changes]' ? this : null;
  }
}

afterEach(() => vi.unstubAllGlobals());

/** A page whose stream has not said anything yet. */
function unheard(access: Access) {
  const store = new Store(access);
  const socket = new FakeSocket();
  const listener = unwatchedSession(store, new Notices(store, () => undefined));
  const timers = new FakeTimers();
  const ask = () => undefined;
  new StreamClient({ open: () => socket, timers, random: () => 0, ask, listener }).connect();
  return { store, socket };
}

describe('what viewers and operators see', () => {
  beforeEach(stubDocument);

  it('is decided by an attribute of the page', () => {
    const root = new FakeElement('html');
    vi.stubGlobal('document', { documentElement: root });
    showAccess('viewer');
    expect(root.dataset['access']).toBe('viewer');
    showAccess('operator');
    expect(root.dataset['access']).toBe('operator');
  });

  it('is first what the page was served as, also for a viewer whom no stream tells', () => {
    const root = new FakeElement('html');
    vi.stubGlobal('document', { documentElement: root });
    const access = () => new Store(servedAccess()).state.access;
    expect(access()).toBe('operator');
    root.dataset['access'] = 'operator';
    expect(access()).toBe('operator');
    root.dataset['access'] = 'viewer';
    const { store, socket } = unheard(servedAccess());
    expect(store.state.mayChange).toBe(false);
    socket.lose();
    expect(store.state.connection.status).toBe('waiting');
    expect(store.state.mayChange).toBe(false);
  });

  it('is what the stream says once it is there', () => {
    const { store, socket } = unheard('viewer');
    socket.hello(2, 'operator');
    expect(store.state.access).toBe('operator');
    socket.hello(2, 'viewer');
    socket.lose();
    expect(store.state.access).toBe('viewer');
  });

  it('has a note only for viewers, and words for each of them', () => {
    const note = viewerNote() as unknown as FakeElement;
    expect(note.attributes.has('data-viewer-only')).toBe(true);
    expect(note.textContent).toMatch(/operator's address/);
    const words = wordsFor('Fly a log', 'Flight logs') as unknown as FakeElement[];
    expect(words.map(({ textContent }) => textContent)).toEqual(['Fly a log', 'Flight logs']);
    expect(words.map(({ attributes }) => [...attributes.keys()])).toEqual([
      ['data-changes'],
      ['data-viewer-only'],
    ]);
  });

  it('is hidden by one rule of the style sheet, so that it takes no focus', () => {
    const [, selectors, style] = /^(\[data-access[^{]*)\{([^}]*)\}/m.exec(kSheet) ?? [];
    expect(selectors?.split(',').map((selector) => selector.trim())).toEqual([
      "[data-access='viewer'] [data-changes]",
      ":root:not([data-access='viewer']) [data-viewer-only]",
    ]);
    expect(style?.trim()).toBe('display: none !important;');
  });
});

describe('a click on what changes something', () => {
  const access = { mayChange: false };
  let click: (event: unknown) => void;

  beforeEach(() => {
    vi.stubGlobal('Element', Place);
    const addEventListener = (type: string, listener: typeof click, options: unknown) => {
      expect([type, options]).toEqual(['click', { capture: true }]);
      click = listener;
    };
    vi.stubGlobal('document', { addEventListener });
    guardChanges(access);
  });

  /** @return whether it comes through to the element and its form */
  function comesThrough(marked: boolean): boolean {
    const event = {
      target: new Place(marked),
      preventDefault: vi.fn(),
      stopPropagation: vi.fn(),
    };
    click(event);
    expect(event.preventDefault.mock.calls).toHaveLength(event.stopPropagation.mock.calls.length);
    return event.preventDefault.mock.calls.length === 0;
  }

  it('does nothing for a viewer, and all else works', () => {
    access.mayChange = false;
    expect(comesThrough(true)).toBe(false);
    expect(comesThrough(false)).toBe(true);
  });

  it('works for an operator, also for one who was a viewer before', () => {
    access.mayChange = true;
    expect(comesThrough(true)).toBe(true);
  });
});
