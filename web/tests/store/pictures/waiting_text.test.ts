import { describe, expect, it } from 'vitest';
import type { Run } from '../../../src/protocol/rest_types';
import { refusalText, waitingText } from '../../../src/store/pictures/waiting_text';
import { WatchedRun } from '../../../src/store/watched_run';
import { sampleRun } from '../../support/samples';

function watchedRun(change: Partial<Run>): WatchedRun {
  const watched = new WatchedRun('r1');
  watched.run = sampleRun(change);
  return watched;
}

describe('waitingText', () => {
  const running = { status: 'running', frames: 0 } as const;
  it.each<[Partial<Run>, string]>([
    [{ status: 'queued' }, 'The run is queued.'],
    [running, 'Waiting for the first picture'],
    [{ ...running, notice: 'making the built-in world: 30 %' }, 'Making the built-in world: 30 %'],
    [{ status: 'failed', frames: 0 }, 'The run failed.'],
    [{ status: 'cancelled', frames: 0 }, 'The run was cancelled before its first picture.'],
    [{ status: 'interrupted', frames: 0 }, 'The run was interrupted before its first picture.'],
    [{ status: 'unreadable', frames: 0 }, 'The run cannot be read.'],
    [{ status: 'completed', frames: 63 }, 'Waiting for the first picture'],
  ])('of %j', (change, text) => expect(waitingText(watchedRun(change))).toBe(text));

  it('asks for a run without one', () => {
    expect(waitingText(null)).toContain('Choose a run');
  });
});

describe('refusalText', () => {
  it('is the reason of the server, by picture', () => {
    const watched = watchedRun({});
    watched.refusals.set('scene', 'the world cannot be opened');
    expect(refusalText(watched, 'scene')).toBe('The world cannot be opened');
    expect(refusalText(watched, 'camera')).toBeNull();
  });
});
