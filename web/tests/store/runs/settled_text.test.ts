import { describe, expect, it } from 'vitest';
import { settledText } from '../../../src/store/runs/settled_text';
import { sampleRun } from '../../support/samples';

describe('settledText', () => {
  const listed = sampleRun({ status: 'running', frames: 10, left_s: 30 });

  it('is the same for a run of the list and of the stream', () => {
    // As the session puts them together.
    const { results, tags, note, ...streamed } = listed;
    const together = { results, tags, note, ...streamed };
    expect(JSON.stringify(together)).not.toBe(JSON.stringify(listed));
    expect(settledText(together)).toBe(settledText(listed));
  });

  it('leaves out only the progress', () => {
    const later = {
      ...listed,
      frames: 20,
      duration_ns: 7,
      left_s: 20,
      notice: 'opening the world',
    };
    expect(settledText({ ...later, queue_position: 2 })).toBe(settledText(listed));
    expect(settledText({ ...listed, flight: 'hover' })).not.toBe(settledText(listed));
    expect(settledText({ ...listed, status: 'cancelled' })).not.toBe(settledText(listed));
    expect(settledText({ ...listed, tags: ['kept'] })).not.toBe(settledText(listed));
  });
});
