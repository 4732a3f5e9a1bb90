import { describe, expect, it, vi } from 'vitest';
import { RestError } from '../../../src/connection/rest_error';
import type { SweepComparison, SweepFiles } from '../../../src/protocol/sweep_types';
import { Store } from '../../../src/store/state';
import { SweepResults } from '../../../src/store/sweeps/sweep_results';

const comparison: SweepComparison = {
  pairs: 3,
  without_pair: 1,
  failed: 0,
  quantities: [{ quantity: 'success_rate', flights: 3, sweep: 1, baseline: 0.5 }],
  conditions: [],
};
const files: SweepFiles = { files: [], published: ['paper'], jobs: { default: 1, most: 2 } };

function results() {
  const store = new Store();
  store.state.sweepPage.name = 'night';
  const client = {
    files: vi.fn(() => Promise.resolve(files)),
    tables: vi.fn(() => Promise.resolve(new Blob(['| a |']))),
    compare: vi.fn(() => Promise.resolve(comparison)),
  };
  const error = vi.fn();
  const made = new SweepResults(store, client, { error });
  return { made, client, error, state: () => store.state.sweepPage.results, store };
}

describe('SweepResults', () => {
  it('names the file of a table by sweep and format', async () => {
    const { made, client } = results();
    const file = await made.table('night', 'latex');
    expect(file?.fileName).toBe('night.tex');
    expect(client.tables).toHaveBeenCalledWith('night', { format: 'latex' });
  });

  it('shows published errors next to those of the sweep, for the estimators that are named', async () => {
    const { made, client, state } = results();
    await made.readPublished();
    expect(state().published).toEqual(['paper']);
    made.set({ counterparts: ' feature=ORB-SLAM2, dso = DSO ' });
    await made.table('night', 'csv');
    expect(client.tables).toHaveBeenLastCalledWith('night', { format: 'csv' });
    made.set({ publishedName: 'paper' });
    await made.table('night', 'csv');
    expect(client.tables).toHaveBeenLastCalledWith('night', {
      format: 'csv',
      published: 'paper',
      as: 'feature=ORB-SLAM2,dso=DSO',
    });
  });

  it('says why a table cannot be saved', async () => {
    const { made, client, error } = results();
    client.tables.mockRejectedValueOnce(new RestError(404, 'not_found', 'no flight is over'));
    expect(await made.table('night', 'html')).toBeNull();
    expect(error).toHaveBeenCalledWith('The tables cannot be saved: no flight is over');
  });

  it('compares by the conditions, one a line', async () => {
    const { made, client, state } = results();
    await made.compare('night');
    expect(client.compare).not.toHaveBeenCalled();
    made.set({ baseline: 'day', estimator: 'feature', conditions: ' success_rate < 1 \n\n' });
    await made.compare('night');
    expect(client.compare).toHaveBeenCalledWith('night', {
      baseline: 'day',
      estimator: 'feature',
      conditions: ['success_rate < 1'],
    });
    expect(state().comparison).toEqual(comparison);
    expect(state().comparing).toBe(false);
  });

  it('shows the reason instead, and drops the answer of another sweep', async () => {
    const { made, client, state, store } = results();
    made.set({ baseline: 'day' });
    client.compare.mockRejectedValueOnce(new RestError(400, 'invalid', 'success: unknown'));
    await made.compare('night');
    expect(state().comparison).toBe('success: unknown');
    const late = made.compare('night');
    store.state.sweepPage.name = 'other';
    await late;
    expect(state().comparison).toBe('success: unknown');
    expect(state().comparing).toBe(false);
  });

  it.each([{ baseline: 'dusk' }, { estimator: 'feature' }])(
    'drops the answer when something else is to be compared: %o',
    async (change) => {
      const { made, state } = results();
      made.set({ baseline: 'day' });
      const late = made.compare('night');
      made.set(change);
      await late;
      expect(state().comparison).toBeNull();
      expect(state().comparing).toBe(false);
    },
  );
});
