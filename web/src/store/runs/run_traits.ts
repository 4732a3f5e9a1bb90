// What is flown in each run of a list: apart what differs from the other runs of its title.
import type { Run } from '../../protocol/rest_types';

export interface RunTraits {
  /** Airspeed, height, ..., estimators, pacing, seed; in the order of the whole. */
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
  const traits = new Map(runs.map((run) => [run, traitsOf(run)]));
  // Flights of different kinds have different traits: only equal numbers of them are comparable.
  const groups = new Map<string, Run[]>();
  for (const run of runs) {
    const key = `${run.title || run.scenario}\n${traits.get(run)?.length ?? 0}`;
    const group = groups.get(key);
    if (group === undefined) groups.set(key, [run]);
    else group.push(run);
  }
  const found = new Map<string, RunTraits>();
  for (const group of groups.values()) {
    const columns = traits.get(group[0] as Run)?.length ?? 0;
    const differs = Array.from({ length: columns }, (_, k) => {
      return new Set(group.map((run) => traits.get(run)?.[k]?.text)).size > 1;
    });
    for (const run of group) {
      const own = traits.get(run) ?? [];
      const texts = (keep: (trait: Trait, k: number) => boolean) =>
        own.filter(keep).flatMap(({ text }) => (text === '' ? [] : [text]));
      found.set(run.id, {
        differing: texts((_, k) => differs[k] === true),
        common: texts(({ always }, k) => always && differs[k] !== true),
      });
    }
  }
  return found;
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
