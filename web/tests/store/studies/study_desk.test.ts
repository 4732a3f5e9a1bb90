import { beforeEach, describe, expect, it, vi } from 'vitest';
import { RestClient } from '../../../src/connection/rest_client';
import { StudyClient } from '../../../src/connection/study_client';
import type { StudyEntry } from '../../../src/protocol/study_types';
import type { Notices } from '../../../src/store/notices';
import type { Session } from '../../../src/store/session';
import { Store } from '../../../src/store/state';
import { StudyDesk } from '../../../src/store/studies/study_desk';
import { studyEntry } from '../../support/studies';

let store: Store;
let asked: string[];
let studies: StudyEntry[];
let failing: boolean;
let waiting: { callback: () => void; delay_ms: number }[];
const selectRun = vi.fn();
const notices = { info: vi.fn(), error: vi.fn() };
let desk: StudyDesk;

const next = async () => {
  waiting.shift()?.callback();
  await new Promise((resolve) => setTimeout(resolve));
};

beforeEach(() => {
  store = new Store();
  asked = [];
  studies = [studyEntry('b', 'running'), studyEntry('a', 'done')];
  failing = false;
  waiting = [];
  selectRun.mockClear();
  notices.info.mockClear();
  notices.error.mockClear();
  const rest = new RestClient('api', (url, init) => {
    asked.push(init?.method === 'GET' ? url : `${init?.method} ${url}`);
    if (failing) {
      const error = { code: 'conflict', message: 'study "b" has not ended' };
      return Promise.resolve(Response.json({ error }, { status: 409 }));
    }
    if (init?.method === 'DELETE') return Promise.resolve(new Response(null, { status: 204 }));
    if (url === 'api/studies') return Promise.resolve(Response.json({ studies, limits: null }));
    const study = studies.find(({ name }) => url.startsWith(`api/studies/${name}`));
    return Promise.resolve(Response.json({ study, result: null }));
  });
  desk = new StudyDesk(
    store,
    new StudyClient(rest),
    rest,
    { selectRun } as unknown as Session,
    notices as unknown as Notices,
    (callback, delay_ms) => waiting.push({ callback, delay_ms }),
  );
});

describe('StudyDesk', () => {
  it('shows the newest study, and reads again soon while one is made or waits', async () => {
    await desk.open();
    expect(store.state.studyPage.name).toBe('b');
    expect(store.state.studyPage.shown?.study.name).toBe('b');
    expect(waiting.map(({ delay_ms }) => delay_ms)).toEqual([2000]);
    studies = [studyEntry('b', 'waiting'), studyEntry('a', 'done')];
    await next();
    expect(waiting.map(({ delay_ms }) => delay_ms)).toEqual([2000]);
    studies = [studyEntry('b', 'done'), studyEntry('a', 'done')];
    await next();
    expect(waiting.map(({ delay_ms }) => delay_ms)).toEqual([15000]);
  });

  it('reads only the list of a closed page, until no study is made any more', async () => {
    await desk.open();
    desk.close();
    asked = [];
    await next();
    expect(asked).toEqual(['api/studies']);
    studies = [studyEntry('b', 'done')];
    await next();
    expect(waiting).toEqual([]);
    expect(notices.info).toHaveBeenCalledWith('Title of b: the study is complete.');
  });

  it('says how a study ended, but not that the viewer cancelled it', async () => {
    await desk.open();
    studies = [studyEntry('b', 'failed', { problem: 'signal 9 (Killed)' })];
    await next();
    expect(notices.error).toHaveBeenLastCalledWith('Title of b: failed. signal 9 (Killed)');
    studies = [studyEntry('b', 'running')];
    await next();
    await desk.cancel('b');
    studies = [studyEntry('b', 'cancelled')];
    waiting = waiting.slice(-1);
    await next();
    expect(asked).toContain('POST api/studies/b/cancel');
    expect(notices.info).not.toHaveBeenCalled();
  });

  it('says why it cannot do what is asked', async () => {
    await desk.open();
    failing = true;
    await desk.remove('b');
    expect(notices.error).toHaveBeenCalledWith('study "b" has not ended');
    expect(store.state.studyPage.error).toBe('study "b" has not ended');
  });

  it('shows another study after one was deleted', async () => {
    await desk.open();
    await desk.choose('a');
    studies = [studyEntry('b', 'done')];
    await desk.remove('a');
    expect(asked).toContain('DELETE api/studies/a');
    expect(store.state.studyPage.name).toBe('b');
  });

  it('does not open its page again when it was closed meanwhile', async () => {
    for (const act of [() => desk.cancel('b'), () => desk.continue('a'), () => desk.remove('a')]) {
      await desk.open();
      asked = [];
      waiting = [];
      const acting = act();
      desk.close();
      await acting;
      expect(store.state.studyPage.open).toBe(false);
      // The list of a closed page, and again while a study is made.
      expect(asked.slice(1)).toEqual(['api/studies']);
      expect(waiting).toHaveLength(1);
    }
  });

  it('opens at the study of an address', async () => {
    await desk.openAt('a');
    expect(store.state.studyPage.open).toBe(true);
    expect(store.state.studyPage.name).toBe('a');
    await desk.openAt('gone');
    expect(store.state.studyPage.name).toBe('b');
  });

  it('opens a flight and closes the page', async () => {
    await desk.open();
    desk.openRun('b.0123456789abcdef0123');
    expect(selectRun).toHaveBeenCalledWith('b.0123456789abcdef0123');
    expect(store.state.studyPage.open).toBe(false);
  });
});
