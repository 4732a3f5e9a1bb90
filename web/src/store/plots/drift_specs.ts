// Errors over the distance flown: relative pose errors of sub-paths by their length, from the scores.
import { csvLine } from '../csv';
import type { State } from '../state';
import { shownAlignment } from '../state';
import { drawnTracks } from '../tracks';
import type { CurveHue } from './plot_specs';
import { hueOf } from './plot_specs';
import type { SharedExtent } from './shared_extent';
import { sharedExtent } from './shared_extent';

export interface DriftCurve {
  name: string;
  hue: CurveHue;
  /** Ascending lengths of sub-paths. */
  lengths_m: number[];
  values: number[];
  /** Number of sub-paths of each length. */
  pairs: number[];
}

export interface DriftSpec {
  key: string;
  label: string;
  unit: string;
  hint: string;
  digits: number;
  /** The axis reaches at least to it, so that noise does not fill the plot. */
  least: number;
  curves: DriftCurve[];
}

const kFigures = [
  {
    key: 'translation_percent',
    label: 'Translation error',
    unit: '%',
    hint: 'Root mean square over all sub-paths of a length, each aligned at its beginning, in % of the length',
    digits: 3,
    least: 0.1,
  },
  {
    key: 'rotation_deg_per_100m',
    label: 'Rotation error',
    unit: 'deg / 100 m',
    hint: 'Root mean square over all sub-paths of a length, each aligned at its beginning, by 100 m of it',
    digits: 4,
    least: 0.01,
  },
] as const;

/** Of the values of all curves but those of estimates that have diverged; null without values. */
export function driftExtent({ curves, least }: DriftSpec): SharedExtent | null {
  const extents = curves.map(({ values }) =>
    values.length === 0
      ? null
      : { low: [Math.min(...values)], high: [Math.max(...values)], estimate: true },
  );
  return sharedExtent(extents, least);
}

/** The relative errors of an estimate, by ascending length. */
export interface ScoredDrift {
  name: string;
  hue: CurveHue;
  relative: readonly {
    length_m: number;
    pairs: number;
    translation_percent: number;
    rotation_deg_per_100m: number;
  }[];
}

/** One curve for each shown estimate that has figures under the shown alignment. */
export function driftSpecs(state: Pick<State, 'watched' | 'colours'>): DriftSpec[] {
  const scored = drawnTracks(state).flatMap((track) => {
    const { run, name, label, by } = track;
    const errors = run.metrics?.estimators?.[name]?.alignments?.[by ?? shownAlignment(run)];
    const relative = [...(errors?.relative ?? [])].sort((a, b) => a.length_m - b.length_m);
    return relative.length > 0 ? [{ name: label, hue: hueOf(track), relative }] : [];
  });
  return driftSpecsOf(scored);
}

export function driftSpecsOf(scored: readonly ScoredDrift[]): DriftSpec[] {
  if (scored.length === 0) return [];
  return kFigures.map((figure) => ({
    ...figure,
    curves: scored.map(({ name, hue, relative }) => ({
      name,
      hue,
      lengths_m: relative.map(({ length_m }) => length_m),
      values: relative.map((one) => one[figure.key]),
      pairs: relative.map(({ pairs }) => pairs),
    })),
  }));
}

/** The value of a curve at a length; null if it has none. */
export function driftAt({ lengths_m, values }: DriftCurve, length_m: number): number | null {
  return values[lengths_m.indexOf(length_m)] ?? null;
}

/** The length, among those of all curves, that is nearest to another one; null without curves. */
export function nearestLength(curves: readonly DriftCurve[], length_m: number): number | null {
  let nearest: number | null = null;
  for (const known_m of curves.flatMap(({ lengths_m }) => lengths_m)) {
    const off_m = Math.abs(known_m - length_m);
    if (nearest === null || off_m < Math.abs(nearest - length_m)) nearest = known_m;
  }
  return nearest;
}

/** All figures, one line for each length of each curve. */
export function driftCsv(specs: readonly DriftSpec[]): string {
  const lines = specs.flatMap(({ key, curves }) =>
    curves.flatMap(({ name, lengths_m, values, pairs }) =>
      lengths_m.map((length_m, i) =>
        csvLine([key, name, length_m, values[i] ?? '', pairs[i] ?? '']),
      ),
    ),
  );
  return csvLine(['figure', 'estimate', 'length_m', 'value', 'sub_paths']) + lines.join('');
}
