// The colours that the viewer gave to tracks. The browser keeps them, an address holds them.
import type { Storage } from './layouts/layouts';
import type { Store } from './state';

/** A number of the palette, which suits both themes, or six hexadecimal digits. */
export type TrackColour = string;

/** In the order of styles/themes.css, --estimate-1 and so on. */
export const kPaletteNames = ['Blue', 'Teal', 'Amber', 'Violet', 'Petrol', 'Magenta'] as const;

const kKey = 'overfly.track-colours';
const kMostKept = 200;
const kLongestKey = 400;

export function isTrackColour(text: unknown): text is TrackColour {
  return typeof text === 'string' && /^(?:[1-6]|[0-9a-f]{6})$/.test(text);
}

/** Of a track in State.colours. @param name  of the estimator; '' = the truth */
export function colourKey(run: string, name: string): string {
  return `${run}/${name}`;
}

/** The colours of a run, by the name of the estimator. */
export function coloursOf(
  colours: ReadonlyMap<string, TrackColour>,
  run: string,
): Map<string, TrackColour> {
  const begin = colourKey(run, '');
  const own = [...colours].filter(([key]) => key.startsWith(begin));
  return new Map(own.map(([key, colour]) => [key.slice(begin.length), colour]));
}

export class TrackColours {
  constructor(
    private readonly store: Store,
    private readonly storage: Storage,
  ) {
    store.state.colours = this.read();
  }

  /** @param colour  null = as usual */
  choose(run: string, name: string, colour: TrackColour | null): void {
    const { state } = this.store;
    const key = colourKey(run, name);
    const withChoice = (before: ReadonlyMap<string, TrackColour>) => {
      const colours = new Map(before);
      colours.delete(key);
      if (colour !== null) colours.set(key, colour);
      return colours;
    };
    state.colours = withChoice(state.colours);
    // Those of a link are not the viewer's, and last only as long as the page.
    const kept = withChoice(this.read());
    try {
      this.storage.setItem(kKey, JSON.stringify([...kept].slice(-kMostKept)));
    } catch {
      // Without storage the colours last until the page is closed.
    }
    this.store.change('run', 'rows');
  }

  /** What is not in order is left out. */
  private read(): Map<string, TrackColour> {
    try {
      const kept: unknown = JSON.parse(this.storage.getItem(kKey) ?? '[]');
      const entries: unknown[] = Array.isArray(kept) ? kept.slice(-kMostKept) : [];
      return new Map(entries.flatMap((entry) => (isEntry(entry) ? [entry] : [])));
    } catch {
      return new Map();
    }
  }
}

function isEntry(value: unknown): value is [string, TrackColour] {
  if (!Array.isArray(value) || value.length !== 2) return false;
  const [key, colour] = value as unknown[];
  return typeof key === 'string' && key.length <= kLongestKey && isTrackColour(colour);
}
