import { describe, expect, it } from 'vitest';
import { repeatsCsv } from '../../../src/store/runs/repeats_csv';

describe('repeatsCsv', () => {
  it('has a line for each flight of each estimator', () => {
    const none = { summary: null, outcomes: [] };
    const errors = [
      { run: 'r1', error_m: 0.25 },
      { run: 'r2', error_m: 1 / 3 },
    ];
    const csv = repeatsCsv([
      { estimator: 'feature', errors, ...none },
      { estimator: 'lost', errors: [], ...none },
    ]);
    expect(csv).toBe(
      'estimator,run,position_rmse_m\nfeature,r1,0.25\nfeature,r2,0.3333333333333333\n',
    );
  });
});
