// Commands that are found by typing parts of their names.

export interface Command {
  /** Unique. */
  id: string;
  /** What it belongs to, e.g. "Layout". */
  group: string;
  title: string;
  /** Further words by which it is found. */
  words?: string;
  /** Keys that do the same. */
  keys?: string;
  /** It starts or changes something on the server: a viewer is not offered it. */
  changes?: true;
  run: () => void;
}

const kMost = 60;

/** Commands with all the words of `query`, the best first; all of them for an empty query. */
export function matchingCommands(commands: readonly Command[], query: string): Command[] {
  const words = query
    .toLowerCase()
    .split(/\s+/)
    .filter((word) => word !== '');
  const scored = commands.flatMap((command, order) => {
    const score = scoreOf(command, words);
    return score === null ? [] : [{ command, score, order }];
  });
  scored.sort((a, b) => b.score - a.score || a.order - b.order);
  return scored.slice(0, kMost).map(({ command }) => command);
}

/** null if a word is missing; a word counts most at the beginning of the title, then of a word. */
function scoreOf({ group, title, words = '' }: Command, wanted: readonly string[]): number | null {
  const name = title.toLowerCase();
  const all = `${name} ${group} ${words}`.toLowerCase();
  let score = 0;
  for (const word of wanted) {
    if (name.startsWith(word)) score += 4;
    else if (startsWord(name, word)) score += 3;
    else if (startsWord(all, word)) score += 2;
    else if (all.includes(word)) score += 1;
    else return null;
  }
  return score;
}

function startsWord(text: string, word: string): boolean {
  return text.split(/[^\p{L}\p{N}]+/u).some((one) => one.startsWith(word));
}

/** The entry after moving by `step` through `count` entries; the ends are joined. */
export function movedChoice(choice: number, step: number, count: number): number {
  return count === 0 ? 0 : (((choice + step) % count) + count) % count;
}
