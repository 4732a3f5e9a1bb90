// Tracks as files: the positions of paths and of the 3D plot.
import { csvLine } from '../csv';
import type { State } from '../state';
import { drawnTracks, tableOf } from '../tracks';

/** All positions of the shown tracks, one line each. Times are those of the clock. */
export function tracksCsv(state: Pick<State, 'watched' | 'colours'>): string {
  const lines = [csvLine(['run', 'track', 't_s', 'x_m', 'y_m', 'z_m'])];
  for (const track of drawnTracks(state)) {
    const table = tableOf(track);
    if (table === undefined) continue;
    const { run, name, by } = track;
    const own = name === '' ? 'truth' : name;
    const title = by === undefined ? own : `${own} by ${by}`;
    const [t_ns, ...axes] = ['t_ns', 'x_m', 'y_m', 'z_m'].map((column) => table.column(column));
    for (let row = 0; row < table.length; row += 1) {
      const place = axes.map((values) => values[row] ?? NaN);
      if (place.some(Number.isNaN)) continue;
      const t_s = Number((((t_ns?.[row] ?? NaN) + run.offset_ns) / 1e9).toFixed(9));
      lines.push(csvLine([run.id, title, t_s, ...place]));
    }
  }
  return lines.join('');
}
