// While estimates are drawn by two alignments: which line is which, each with its scale.
import { formatNumber } from '../store/format';
import { hueOf } from '../store/plots/plot_specs';
import type { State } from '../store/state';
import { shownAlignment } from '../store/state';
import type { Track } from '../store/tracks';
import { drawnTracks, scaleOf } from '../store/tracks';
import { curveStyle, trackColour } from './colours';
import { h, rebuild } from './dom';

/** The scale of an estimate, while two alignments are compared; else ''. */
function scaleText(track: Track, compared: string | null): string {
  if (compared === null || track.name === '') return '';
  return `, scale ${formatNumber(scaleOf(track), 4)}`;
}

export interface LegendEntry {
  text: string;
  colour: string;
  dashed: boolean;
}

/** The tracks of a view, each with its scale while two alignments are compared. */
export function legendEntries(tracks: readonly Track[], compared: string | null): LegendEntry[] {
  return tracks.map((track) => ({
    text: `${track.label}${scaleText(track, compared)}`,
    colour: trackColour(track),
    dashed: curveStyle(hueOf(track)).dash.length > 0,
  }));
}

export function legendLine({ text, colour, dashed }: LegendEntry): HTMLElement {
  return h('span', {}, h('i', { class: dashed ? 'dashed' : '', style: `color:${colour}` }), text);
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
    const named = tracks.map((track) =>
      track.by === undefined
        ? { ...track, label: `${track.label} by ${shownAlignment(track.run)}` }
        : track,
    );
    const lines = legendEntries(named, compared);
    rebuild(this.root, JSON.stringify(lines), () => lines.map(legendLine));
  }
}
