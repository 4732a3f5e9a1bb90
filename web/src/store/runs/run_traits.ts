// What is flown in each run of a list, and which of it differs from the other runs of its title.
import type { Run } from '../../protocol/rest_types';

export interface RunTraits {
  /** Airspeed, height, ..., estimators, pacing, seed; always in this order. */
  differing: string[];
  /** The rest of the flight. */
  common: string[];
}

interface Trait {
  text: string;
  /** Shown although it does not differ. */
  always: boolean;
}

/** By run id. */
export function runTraits(runs: readonly Run[]): Map<string, RunTraits> {
  // Flights of different kinds have different traits: only equal numbers of them are comparable.
  const groups = new Map<string, { id: string; traits: Trait[] }[]>();
  for (const run of runs) {
    const traits = traitsOf(run);
    const key = `${run.title || run.scenario}\n${traits.length}`;
    const group = groups.get(key) ?? [];
    group.push({ id: run.id, traits });
    groups.set(key, group);
  }
  const found = new Map<string, RunTraits>();
  for (const group of groups.values()) {
    const differs = (group[0]?.traits ?? []).map(
      (_, k) => new Set(group.map(({ traits }) => traits[k]?.text)).size > 1,
    );
    for (const { id, traits } of group) {
      const texts = (keep: (trait: Trait, k: number) => boolean) =>
        traits.filter(keep).flatMap(({ text }) => (text === '' ? [] : [text]));
      found.set(id, {
        differing: texts((_, k) => differs[k] === true),
        common: texts(({ always }, k) => always && differs[k] !== true),
      });
    }
  }
  return found;
}

/** Texts in the order of RunTraits; '' = none. */
export function traitTexts(run: Run): string[] {
  return traitsOf(run).map(({ text }) => text);
}

function traitsOf({ flight, scenario, estimators, pacing, seed }: Run): Trait[] {
  const flown = flight === '' ? [scenario] : flight.split(', ');
  return [
    ...flown.map((text) => ({ text, always: true })),
    { text: estimators.join(' + '), always: false },
    { text: pacing, always: false },
    { text: `seed ${seed}`, always: true },
  ];
}
