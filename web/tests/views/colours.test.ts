import { describe, expect, it } from 'vitest';
import { curveStyle } from '../../src/views/colours';

describe('curveStyle', () => {
  it('begins the colours of runs again with another dash', () => {
    const looks = Array.from({ length: 12 }, (_, order) => curveStyle({ kind: 'run', order }));
    expect(new Set(looks.map(({ colour, dash }) => `${colour} ${dash.join()}`)).size).toBe(12);
    expect(looks.slice(0, 3).map(({ dash }) => dash)).toEqual([[], [], []]);
    expect(looks[3]?.colour).toBe(looks[0]?.colour);
  });
});
