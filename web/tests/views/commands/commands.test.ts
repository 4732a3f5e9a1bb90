import { describe, expect, it } from 'vitest';
import { Store } from '../../../src/store/state';
import { commandsOf } from '../../../src/views/commands/commands';
import type { Context } from '../../../src/views/view';
import { WatchedRun } from '../../../src/store/watched_run';
import { sampleRun } from '../../support/samples';

/** The commands while a run with a lost estimator is shown. */
function commandIds(access: 'operator' | 'viewer'): string[] {
  const store = new Store();
  const watched = new WatchedRun('r1');
  const lost = {
    estimator: 'feature',
    outcome: 'LOST',
    position_rmse_m: 3,
    position_rmse_percent: 1,
  };
  watched.run = sampleRun({ results: [lost] });
  store.state.main = watched;
  store.state.runs = [watched.run];
  store.setAccess(access);
  const layouts = { ownNames: [], isChanged: false, panels: () => [] };
  const reports = { runs: () => [] };
  return commandsOf({ store, layouts, reports } as unknown as Context).map(({ id }) => id);
}

describe('the commands of the palette', () => {
  it('are fewer for a viewer: none that starts or changes something', () => {
    const viewers = commandIds('viewer');
    const left = commandIds('operator').filter((id) => !viewers.includes(id));
    expect(left).toEqual(['connect', 'explain run', 'predict', 'hunt']);
    expect(viewers).toEqual(expect.arrayContaining(['studies', 'logs', 'editor', 'run r1']));
  });
});
