// Finds runs by words and by fields: "hills seed:3 outcome:lost".
import type { Run } from '../../protocol/rest_types';
import { countedResults } from './counted_results';

/** Fields that a word with a colon searches alone. */
const kFields: Readonly<Record<string, (run: Run) => string[]>> = {
  id: ({ id }) => [id],
  title: ({ title }) => [title],
  scenario: ({ scenario }) => [scenario],
  flight: ({ flight }) => [flight],
  estimator: ({ estimators }) => estimators,
  outcome: outcomesOf,
  status: ({ status }) => [status],
  tag: ({ tags }) => tags,
  note: ({ note }) => [note],
};

/** Matches whole numbers, so that 1 does not find 10. */
const kSeed = 'seed';

export const kSearchFields: readonly string[] = [kSeed, ...Object.keys(kFields)];

type Test = (run: Run) => boolean;

/** The runs that have every word of the text; all if there is none. Case does not matter. */
export function matching(runs: readonly Run[], text: string): Run[] {
  const tests = termsOf(text.toLowerCase()).map(testOf);
  if (tests.length === 0) return [...runs];
  return runs.filter((run) => tests.every((test) => test(run)));
}

/** A text that finds what has a field's value; a value with blanks is put in quotes. */
export function searchFor(field: string, value: string): string {
  return `${field}:${/\s/.test(value) ? `"${value}"` : value}`;
}

interface Term {
  /** '' = a word. */
  field: string;
  value: string;
}

function termsOf(text: string): Term[] {
  const found = text.matchAll(/(?:(\w+):)?"([^"]*)"?|\S+/g);
  return [...found].flatMap(([whole, field = '', quoted]): Term[] => {
    if (quoted === '') return [];
    if (quoted !== undefined && (field === '' || kSearchFields.includes(field))) {
      return [{ field, value: quoted }];
    }
    if (quoted !== undefined) return [{ field: '', value: `${field}:${quoted}` }];
    const [, name = '', value = ''] = /^(\w+):(.+)$/.exec(whole) ?? [];
    return [kSearchFields.includes(name) ? { field: name, value } : { field: '', value: whole }];
  });
}

function testOf({ field, value }: Term): Test {
  if (field === kSeed) return ({ seed }) => String(seed) === value;
  const textsOf = kFields[field];
  if (textsOf === undefined) return (run) => allTexts(run).includes(value);
  return (run) => textsOf(run).some((text) => text.toLowerCase().includes(value));
}

function outcomesOf(run: Run): string[] {
  return countedResults(run).map(({ outcome }) => outcome);
}

function allTexts(run: Run): string {
  const { texture_limited, estimators, tags } = run;
  const limited = texture_limited ? 'texture-limited' : '';
  const { id, title, scenario, flight, status, pacing, note, seed } = run;
  const own = [id, title, scenario, flight, `seed ${seed}`, status, pacing, limited, note];
  return [...own, ...estimators, ...outcomesOf(run), ...tags].join(' ').toLowerCase();
}
