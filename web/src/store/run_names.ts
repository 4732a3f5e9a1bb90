// Short names of runs that are shown together: what differs between them.
import type { Run } from '../protocol/rest_types';
import { formatDate } from './format';
import { traitTexts } from './runs/run_traits';

/** By run id. Runs that differ in nothing else are named by their start. */
export function distinguishingNames(runs: readonly Run[]): Map<string, string> {
  const parts = runs.map((run) => [run.title, ...traitTexts(run)]);
  // Flights of different kinds have different parts: only equal numbers of parts are comparable.
  const comparable = parts.every(({ length }) => length === parts[0]?.length);
  const named = runs.map((run, i) => {
    const own = parts[i] ?? [];
    if (!comparable) return run.flight === '' ? run.title : run.flight;
    const differing = own.filter((part, k) => parts.some((other) => other[k] !== part));
    return differing.filter((part) => part !== '').join(', ');
  });
  return new Map(
    runs.map((run, i) => {
      const name = named[i] ?? '';
      const unique = name !== '' && named.filter((other) => other === name).length === 1;
      const start = formatDate(run.created_utc);
      return [run.id, unique ? name : name === '' ? start : `${name}, ${start}`];
    }),
  );
}
