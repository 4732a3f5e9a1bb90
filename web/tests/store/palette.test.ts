import { describe, expect, it } from 'vitest';
import type { Command } from '../../src/store/palette';
import { matchingCommands, movedChoice } from '../../src/store/palette';

const command = (id: string, group: string, title: string, words = ''): Command => ({
  id,
  group,
  title,
  words,
  run: () => undefined,
});

const kCommands = [
  command('camera', 'Layout', 'Camera', 'the picture, large'),
  command('show', 'Panel', 'Show Camera'),
  command('faster', 'Key', 'Faster'),
  command('r1', 'Open run', 'The course', '20260102-course completed'),
];

describe('the commands', () => {
  const found = (query: string) => matchingCommands(kCommands, query).map(({ id }) => id);

  it('are all there for an empty query', () => {
    expect(found('  ')).toEqual(kCommands.map(({ id }) => id));
  });

  it('begin with those whose title begins so', () => {
    expect(found('cam')).toEqual(['camera', 'show']);
  });

  it('need all words, in any order and case', () => {
    expect(found('CAMERA show')).toEqual(['show']);
    expect(found('camera zebra')).toEqual([]);
  });

  it('are found by their group and further words', () => {
    expect(found('layout')).toEqual(['camera']);
    expect(found('completed 2026')).toEqual(['r1']);
  });

  it('put parts of words last', () => {
    expect(found('ours')).toEqual(['r1']);
    expect(found('a')[0]).not.toBe('faster');
  });

  it('are at most sixty', () => {
    const many = Array.from({ length: 500 }, (_, i) => command(String(i), 'Open run', `Run ${i}`));
    expect(matchingCommands(many, 'run').length).toBe(60);
  });
});

describe('the choice', () => {
  it('goes round', () => {
    expect(movedChoice(0, -1, 3)).toBe(2);
    expect(movedChoice(2, 1, 3)).toBe(0);
    expect(movedChoice(1, 8, 3)).toBe(0);
    expect(movedChoice(0, 1, 0)).toBe(0);
  });
});
