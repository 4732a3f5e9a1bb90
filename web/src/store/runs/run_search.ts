// Finds runs by words.
import type { Run } from '../../protocol/rest_types';

/** The runs that contain every word of the text; all if there is none. Case does not matter. */
export function matching(runs: readonly Run[], text: string): Run[] {
  const words = text
    .toLowerCase()
    .split(/\s+/)
    .filter((word) => word !== '');
  return runs.filter(({ texture_limited, estimators, results, tags, ...run }) => {
    const limited = texture_limited ? 'texture-limited' : '';
    const { id, title, scenario, flight, status, pacing, note } = run;
    const outcomes = results.map(({ outcome }) => outcome);
    const own = [id, title, scenario, flight, status, pacing, limited, note];
    const all = [...own, ...estimators, ...outcomes, ...tags];
    const searched = all.join(' ').toLowerCase();
    return words.every((word) => searched.includes(word));
  });
}
