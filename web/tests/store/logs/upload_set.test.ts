import { describe, expect, it } from 'vitest';
import { uploadQuery, uploadSets } from '../../../src/store/logs/upload_set';

const file = (name: string, size = 3) => ({ name, size });

describe('what is uploaded of several files', () => {
  it('is each log of its own', () => {
    const files = [file('a.bin'), file('b.tlog')];
    expect(uploadSets(files)).toEqual([[files[0]], [files[1]]]);
    expect(uploadQuery([file('my flight.bin')])).toBe('name=my_flight.bin');
  });

  it('is a mapping with its CSV files, the mapping first', () => {
    const [gps, map, log, att] = [
      file('GPS 1.csv'),
      file('x.JSON', 7),
      file('a.bin'),
      file('t.txt'),
    ];
    const sets = uploadSets([gps, map, log, att]);
    expect(sets).toEqual([[map, gps, att], [log]]);
    expect(uploadQuery([map, gps, att])).toBe(
      `files=${encodeURIComponent('x.JSON:7,GPS 1.csv:3,t.txt:3')}`,
    );
  });

  it('is nothing where a part is missing', () => {
    expect(uploadSets([file('m.json')])).toMatch(/^m\.json: choose the CSV files/);
    expect(uploadSets([file('gps.csv')])).toMatch(/^gps\.csv: CSV files are uploaded together/);
    expect(uploadSets([file('m.json'), file('n.json'), file('a.csv')])).toMatch(/^One mapping/);
  });
});
