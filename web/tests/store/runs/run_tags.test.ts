import { describe, expect, it } from 'vitest';
import { knownTags, tagsFrom } from '../../../src/store/runs/run_tags';
import { sampleRun } from '../../support/samples';

describe('tagsFrom', () => {
  it.each([
    ['', []],
    [' , ,', []],
    ['wind', ['wind']],
    [' wind,  for   the paper ,wind', ['wind', 'for the paper']],
  ])('%j', (text, tags) => {
    expect(tagsFrom(text)).toEqual(tags);
  });
});

describe('knownTags', () => {
  it('has each tag once, by name', () => {
    const runs = [sampleRun({ tags: ['set 10', 'b'] }), sampleRun({ tags: ['b', 'set 9'] })];
    expect(knownTags(runs)).toEqual(['b', 'set 9', 'set 10']);
  });
});
