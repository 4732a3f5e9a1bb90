// The picture stream of the 3D view.
import type { PictureStream } from '../../protocol/messages';
import type { State } from '../../store/state';
import { tracksOf } from '../../store/tracks';

/** The scene with all watched runs, each with the colours of its tracks in the plots. */
export function sceneWish(state: State): PictureStream[] {
  const { main } = state;
  if (main === null) return [];
  const firsts = tracksOf(state).filter(({ name }) => name === '');
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
