// While estimates are drawn by two alignments: which line is which, each with its scale.
import { formatNumber } from '../store/format';
import { hueOf } from '../store/plots/plot_specs';
import type { State } from '../store/state';
import { shownAlignment } from '../store/state';
import type { Track } from '../store/tracks';
import { drawnTracks, scaleOf } from '../store/tracks';
import { curveStyle } from './colours';
import { h, rebuild } from './dom';

/** The scale of an estimate, while two alignments are compared; else ''. */
export function scaleText(track: Track, compared: string | null): string {
  if (compared === null || track.name === '') return '';
  return `, scale ${formatNumber(scaleOf(track), 4)}`;
}

export class AlignmentLegend {
  readonly root = h('div', {
    class: 'alignment-legend',
    role: 'note',
    'aria-label': 'Lines and scales of the two alignments',
    hidden: true,
  });

  /** @param matters  whether what is shown depends on the alignment */
  draw(state: State, matters: boolean): void {
    const { compared } = state;
    const tracks = drawnTracks(state).filter(({ name }) => name !== '');
    this.root.hidden = !matters || !tracks.some(({ by }) => by !== undefined);
    const lines = tracks.map((track) => {
      const by = track.by === undefined ? ` by ${shownAlignment(track.run)}` : '';
      return {
        text: `${track.label}${by}${scaleText(track, compared)}`,
        ...curveStyle(hueOf(track)),
      };
    });
    rebuild(this.root, JSON.stringify(lines), () =>
      lines.map(({ text, colour, dash }) =>
        h(
          'span',
          {},
          h('i', { class: dash.length > 0 ? 'dashed' : '', style: `color:${colour}` }),
          text,
        ),
      ),
    );
  }
}
