import { afterEach, beforeEach, expect, it, vi } from 'vitest';
import { kTopics } from '../../../src/store/state';
import type { Context } from '../../../src/views/view';
import { EstimatorTable } from '../../../src/views/status/estimator_table';
import { LogPanel } from '../../../src/views/status/log_panel';
import type { FakeElement } from '../../support/fake_document';
import { stubDocument } from '../../support/fake_document';
import { Viewing } from '../../support/viewing';

beforeEach(stubDocument);
afterEach(() => vi.unstubAllGlobals());

const times = (root: unknown) => (root as FakeElement).textsOf('time');

it('the log has the times of the clock, also after the run was moved on it', () => {
  const { session, socket, store } = viewingOfLog();
  const panel = new LogPanel({ store } as unknown as Context);
  const table = new EstimatorTable();
  panel.update(kTopics);
  table.draw(store.state);
  expect(times(panel.root)).toEqual(['00:01.000']);
  expect(times(table.root)).toEqual(['00:01.000']);
  store.take();
  session.setOffset('r1', 60e9);
  panel.update(store.take());
  table.draw(store.state);
  expect(times(panel.root)).toEqual(['01:01.000']);
  expect(times(table.root)).toEqual(['01:01.000']);
  expect(socket.sent.at(-1)).toMatchObject({ type: 'watch', offset_ns: 60e9 });
});

function viewingOfLog(): Viewing {
  const viewing = new Viewing();
  viewing.watch();
  const columns = {
    t_ns: [1e9],
    level: ['info'],
    text: ['lost'],
    kind: [''],
    source: ['feature'],
  };
  viewing.socket.receive({ type: 'rows', run: 'r1', stream: 'log', seq: 0, columns });
  return viewing;
}
