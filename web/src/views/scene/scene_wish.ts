// The picture stream of the 3D view.
import type { PictureStream, SceneTracks } from '../../protocol/messages';
import type { State } from '../../store/state';
import type { TrackColour } from '../../store/track_colours';
import type { Track } from '../../store/tracks';
import { tracksOf } from '../../store/tracks';

/** The palette as the server draws it over the ground: estimator_rgb in server/views/track_look.cpp. */
const kPalette = ['#2673ff', '#1ab859', '#f2a61a', '#a659e6', '#3dd1ab', '#e678bf'] as const;

/**
 * The scene with the shown tracks of the watched runs, in their colours. The main run is always part
 * of it, as the viewpoint is at its aircraft.
 */
export function sceneWish(state: State): PictureStream[] {
  const { main } = state;
  if (main === null) return [];
  const tracks = tracksOf(state);
  const looks = state.watched.flatMap((run) => {
    const own = tracks.filter((track) => track.run === run);
    return run === main || own.some(({ shown }) => shown) ? [lookOf(own)] : [];
  });
  const own = looks.find(({ run }) => run === main.id);
  const others = looks.filter((one) => one !== own);
  const { first_colour = 0, hide, colours } = own ?? {};
  return [
    {
      run: main.id,
      name: 'scene',
      max_hz: 20,
      quality: 80,
      ...(first_colour === 0 ? {} : { first_colour }),
      ...(hide === undefined ? {} : { hide }),
      ...(colours === undefined ? {} : { colours }),
      ...(others.length === 0 ? {} : { with: others }),
      ...(state.compared === null ? {} : { compared: state.compared }),
    },
  ];
}

/** @param tracks  of one run, the truth first */
function lookOf(tracks: readonly Track[]): SceneTracks {
  const [truth] = tracks;
  const hide = tracks.filter(({ shown }) => !shown).map(({ name }) => name);
  const chosen = tracks.flatMap(({ name, chosen: colour }) =>
    colour === null ? [] : [[name, drawnColour(colour)] as const],
  );
  return {
    run: truth?.run.id ?? '',
    first_colour: truth?.colour ?? 0,
    ...(hide.length === 0 ? {} : { hide }),
    ...(chosen.length === 0 ? {} : { colours: Object.fromEntries(chosen) }),
  };
}

function drawnColour(colour: TrackColour): string {
  return colour.length === 1 ? (kPalette[Number(colour) - 1] ?? kPalette[0]) : `#${colour}`;
}
