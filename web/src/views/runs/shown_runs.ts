// The runs that are shown: their tracks and, of several, their offsets and which one is the main.
import { formatNumber } from '../../store/format';
import { distinguishingNames } from '../../store/run_names';
import type { State } from '../../store/state';
import type { Track } from '../../store/tracks';
import { runLetter, tracksOf } from '../../store/tracks';
import type { WatchedRun } from '../../store/watched_run';
import { kMostOffset_ns } from '../../store/watched_run';
import { trackColour } from '../colours';
import { h, rebuild } from '../dom';
import { icon } from '../icons';
import type { Context } from '../view';
import { ColourSheet } from './colour_sheet';

/** Of a single run only its tracks: the rest is in the list. */
export class ShownRuns {
  readonly root = h('ul', { class: 'shown-runs', 'aria-label': 'Runs shown, and their tracks' });

  /** An offset is being typed: new entries would throw it away. */
  private typing = false;
  /** Inputs of the offsets, by run. */
  private readonly offsets = new Map<string, HTMLInputElement>();

  private readonly sheet: ColourSheet;

  constructor(private readonly context: Context) {
    this.sheet = new ColourSheet(context);
    document.body.append(this.sheet.root);
  }

  draw(state: State): void {
    if (this.typing) return;
    const { watched, runId } = state;
    const tracks = tracksOf(state);
    const drawn = tracks.map(({ label, shown, chosen }) => [label, shown, chosen]);
    const names = distinguishingNames(watched.flatMap(({ run }) => run ?? []));
    const nameOf = ({ id, deleted }: WatchedRun) =>
      `${names.get(id) ?? id}${deleted ? ' (deleted)' : ''}`;
    const runs = watched.map((one) => [one.id, nameOf(one)]);
    const single = watched.length < 2;
    rebuild(this.root, JSON.stringify([drawn, runs, runId]), () =>
      single
        ? [h('li', { class: 'shown-run' }, this.tracksOf(tracks))]
        : watched.map((one) =>
            this.entry(
              one,
              nameOf(one),
              runLetter(state, one),
              tracks.filter(({ run }) => run === one),
            ),
          ),
    );
    for (const { id, offset_ns } of watched) {
      const offset = this.offsets.get(id);
      const text = offsetText(offset_ns);
      if (offset !== undefined && offset.value !== text) offset.value = text;
    }
    this.root.hidden = watched.length === 0;
    this.root.classList.toggle('single', single);
  }

  private entry(watched: WatchedRun, name: string, letter: string, tracks: Track[]): HTMLElement {
    const { session, store } = this.context;
    const { id, offset_ns } = watched;
    const isMain = store.state.main === watched;
    const offset = h('input', {
      type: 'number',
      step: 0.1,
      min: -kMostOffset_ns / 1e9,
      max: kMostOffset_ns / 1e9,
      value: offsetText(offset_ns),
      'aria-label': `Offset of run ${letter} in seconds`,
      title: 'Time of the clock at which this run begins [s]',
      oninput: () => {
        this.typing = true;
        const seconds = offset.valueAsNumber;
        if (Number.isFinite(seconds)) session.setOffset(id, Math.round(seconds * 1e9));
      },
      onblur: () => {
        this.typing = false;
        this.draw(store.state);
      },
    });
    this.offsets.set(id, offset);
    return h(
      'li',
      { class: 'shown-run', 'data-shown-run': id, 'aria-current': isMain ? 'true' : 'false' },
      h(
        'button',
        {
          class: 'shown-title',
          title: `${name} (${id}): show its pictures and timeline`,
          onclick: () => session.makeMain(id),
        },
        h('b', { class: 'run-letter' }, letter),
        h('span', {}, name),
      ),
      h('label', { class: 'shown-offset' }, offset, h('span', { class: 'unit' }, 's')),
      h(
        'button',
        {
          class: 'icon-button',
          title: `Remove run ${letter} from the comparison`,
          'aria-label': `Remove run ${letter} from the comparison`,
          onclick: () => session.removeRun(id),
        },
        icon('close'),
      ),
      this.tracksOf(tracks),
    );
  }

  private tracksOf(tracks: readonly Track[]): HTMLElement {
    return h(
      'div',
      { class: 'shown-tracks', role: 'group', 'aria-label': 'Tracks' },
      ...tracks.map((track) => this.trackChip(track)),
    );
  }

  private trackChip(track: Track): HTMLElement {
    const { run, name, label, shown } = track;
    const text = name === '' ? 'truth' : name;
    const colour = h(
      'button',
      {
        class: 'track-colour',
        title: `Choose the colour of ${label}`,
        'aria-label': `Choose the colour of ${label}`,
        'aria-haspopup': 'true',
        onclick: () => this.sheet.open(track, colour),
      },
      h('i', { style: `background:${trackColour(track)}` }),
    );
    const toggle = h(
      'button',
      {
        class: 'track-button',
        'aria-pressed': shown ? 'true' : 'false',
        'aria-label': `Show ${label}`,
        title: `${shown ? 'Hide' : 'Show'} ${label} in the plots and the 3D plot`,
        onclick: () => this.context.session.showTrack(run.id, name, !shown),
      },
      text,
    );
    return h('span', { class: 'track-chip' }, colour, toggle);
  }
}

function offsetText(offset_ns: number): string {
  return formatNumber(offset_ns / 1e9, 3).replace('−', '-');
}
