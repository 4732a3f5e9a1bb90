import { expect, it } from 'vitest';
import { WatchedRun } from '../../src/store/watched_run';
import { playbackMessage, sampleRun, sampleStatus } from '../support/samples';

it('knows whether rows of a flight are still on their way', () => {
  const watched = new WatchedRun('r1');
  const rows = (stream: string, count: number) => {
    const frame = Array.from({ length: count }, (_, k) => k);
    watched.data.apply({ stream, seq: 0, columns: { frame } });
  };
  expect(watched.isRead).toBe(false);
  watched.run = sampleRun({ frames: 3 });
  watched.statuses = {
    feature: sampleStatus({ answered: 2 }),
    silent: sampleStatus({ answered: 0 }),
  };
  watched.instant = playbackMessage().runs['r1'] ?? null;
  expect(watched.isRead).toBe(false);
  rows('truth', 3);
  expect(watched.isRead).toBe(false);
  rows('estimate/feature', 2);
  expect(watched.isRead).toBe(true);
  watched.run = sampleRun({ status: 'running', frames: 9 });
  expect(watched.isRead).toBe(true);
  watched.run = sampleRun({ status: 'failed', frames: 0 });
  expect(watched.isRead).toBe(true);
});
