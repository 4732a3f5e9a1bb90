import { describe, expect, it, vi } from 'vitest';
import { RestError } from '../../../src/connection/rest_error';
import { ReportMaker } from '../../../src/store/runs/report_maker';
import { Notices } from '../../../src/store/notices';
import { Store } from '../../../src/store/state';
import { WatchedRun } from '../../../src/store/watched_run';
import type { RunStatus } from '../../../src/protocol/rest_types';
import { sampleRun } from '../../support/samples';

const page = new Blob(['<!doctype html>'], { type: 'text/html' });

function making(statuses: readonly RunStatus[], report = () => Promise.resolve(page)) {
  const store = new Store();
  store.state.watched = statuses.map((status, i) => {
    const watched = new WatchedRun(`r${i}`);
    watched.run = sampleRun({ id: `r${i}`, status });
    return watched;
  });
  store.state.alignment = 'sim3';
  const rest = { report: vi.fn(report) };
  const maker = new ReportMaker(store, rest, new Notices(store, vi.fn()));
  const texts = () => store.state.notices.map(({ text }) => text);
  return { maker, rest, store, texts };
}

describe('ReportMaker', () => {
  it('reports the shown runs that are over, by the chosen alignment', async () => {
    const { maker, rest, texts } = making(['completed', 'running', 'failed', 'queued']);
    const made = maker.make();
    expect(maker.busy).toBe(true);
    expect(await made).toEqual({ fileName: 'overfly-report-2-runs.html', page });
    expect(rest.report).toHaveBeenCalledWith(['r0', 'r2'], 'sim3');
    expect(maker.busy).toBe(false);
    expect(texts()).toEqual([]);
  });

  it('names the file after a single run', async () => {
    const { maker } = making(['completed']);
    expect((await maker.make())?.fileName).toBe('overfly-report-r0.html');
  });

  it('asks for nothing without a run that is over', async () => {
    const none = making(['running']);
    expect(await none.maker.make()).toBeNull();
    expect(none.texts()[0]).toMatch(/None of the shown runs has ended/);
    expect(none.rest.report).not.toHaveBeenCalled();
  });

  it('leaves out a run that somebody has deleted', async () => {
    const { maker, rest, store, texts } = making(['completed', 'completed']);
    const [first, second] = store.state.watched;
    if (first === undefined || second === undefined) throw new Error('no runs');
    first.deleted = true;
    await maker.make();
    expect(rest.report).toHaveBeenCalledWith(['r1'], 'sim3');
    second.deleted = true;
    expect(await maker.make()).toBeNull();
    expect(texts()[0]).toMatch(/is on the server/);
  });

  it('says why the server makes none, and can be asked again', async () => {
    const refuse = () => Promise.reject(new RestError(409, 'conflict', 'run r0 is not over'));
    const { maker, texts } = making(['completed'], refuse);
    expect(await maker.make()).toBeNull();
    expect(texts()).toEqual(['The report cannot be made: run r0 is not over']);
    expect(maker.busy).toBe(false);
  });

  it('makes one report at a time', async () => {
    const { maker, rest, texts } = making(['completed']);
    const first = maker.make();
    expect(await maker.make()).toBeNull();
    expect(texts()).toEqual(['A report is being made already.']);
    await first;
    expect(rest.report).toHaveBeenCalledTimes(1);
  });
});
