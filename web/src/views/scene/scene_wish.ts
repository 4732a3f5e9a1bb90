// The picture stream of the 3D view.
import type { PictureStream } from '../../protocol/messages';
import type { State } from '../../store/state';
import { tracksOf } from '../../store/tracks';
import type { WatchedRun } from '../../store/watched_run';

/**
 * The scene with the watched runs of which a track is shown, each with the colours of its tracks in
 * the plots. The main run is always part of it.
 */
export function sceneWish(state: State): PictureStream[] {
  const { main } = state;
  if (main === null) return [];
  const tracks = tracksOf(state);
  const seen = (one: WatchedRun) => tracks.some(({ run, shown }) => shown && run === one);
  const firsts = tracks.filter(({ name, run }) => name === '' && (run === main || seen(run)));
  const all = firsts.map(({ run, colour }) => ({ run: run.id, first_colour: colour }));
  const own = all.find(({ run }) => run === main.id);
  return [
    {
      run: main.id,
      name: 'scene',
      max_hz: 20,
      quality: 80,
      ...(own === undefined || own.first_colour === 0 ? {} : { first_colour: own.first_colour }),
      ...(all.length < 2 ? {} : { with: all.filter((one) => one !== own) }),
    },
  ];
}
