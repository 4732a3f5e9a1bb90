import { describe, expect, it } from 'vitest';
import { tracksCsv } from '../../../src/store/plots/track_files';
import { Viewing } from '../../support/viewing';

describe('tracksCsv', () => {
  it('has the positions of the shown tracks by the clock, without frames that have none', () => {
    const viewing = new Viewing();
    viewing.watch();
    viewing.session.setOffset('r1', 5e9);
    const rows = (stream: string, x_m: (number | null)[]) =>
      viewing.socket.receive({
        type: 'rows',
        run: 'r1',
        stream,
        seq: 0,
        columns: { t_ns: [0, 1e9 / 31, 2e9], x_m, y_m: [4, 5, 6], z_m: [7, 8, 9] },
      });
    rows('truth', [1, 2, 3]);
    rows('estimate/feature', [1.5, null, 3.5]);
    expect(tracksCsv(viewing.store.state).trimEnd().split('\n')).toEqual([
      'run,track,t_s,x_m,y_m,z_m',
      'r1,truth,5,1,4,7',
      'r1,truth,5.032258065,2,5,8',
      'r1,truth,7,3,6,9',
      'r1,feature,5,1.5,4,7',
      'r1,feature,7,3.5,6,9',
    ]);
    viewing.session.showTrack('r1', '', false);
    expect(tracksCsv(viewing.store.state)).not.toContain('truth');
  });
});
