// The strips of a mission's profile: which values, their limits and ranges.
import type { MissionLimits, MissionSamples } from '../../protocol/mission_types';

export interface Strip {
  label: string;
  curves: readonly { colour: string; values: (samples: MissionSamples) => (number | null)[] }[];
  /** The ground is drawn below the curves. */
  ground?: boolean;
  limit?: (limits: MissionLimits) => number;
  /** A few values, such as those at take-off, may be beyond what is shown. */
  robust?: boolean;
  /** The least range that is shown. */
  shows: readonly [number, number] | null;
}

export const kStrips: readonly Strip[] = [
  {
    label: 'Path and ground: height above the ellipsoid [m]',
    curves: [{ colour: 'var(--accent)', values: ({ alt_ellipsoid_m }) => alt_ellipsoid_m }],
    ground: true,
    shows: null,
  },
  {
    label: 'Bank [deg]',
    curves: [
      { colour: 'var(--axis-x)', values: ({ roll_deg }) => roll_deg.map((roll) => Math.abs(roll)) },
    ],
    limit: ({ max_bank_deg }) => max_bank_deg,
    shows: [0, 30],
  },
  {
    label: 'Image motion per frame [px]: translation, rotation',
    curves: [
      { colour: 'var(--estimate-1)', values: ({ translation_px }) => translation_px },
      { colour: 'var(--estimate-3)', values: ({ rotation_px }) => rotation_px },
    ],
    limit: ({ max_motion_px }) => max_motion_px,
    robust: true,
    shows: [0, 5],
  },
  {
    label: 'Overlap',
    curves: [{ colour: 'var(--axis-y)', values: ({ overlap }) => overlap }],
    limit: ({ min_overlap }) => min_overlap,
    shows: [0, 1],
  },
  {
    label: 'Texels per pixel',
    curves: [{ colour: 'var(--axis-z)', values: ({ texels_px }) => texels_px }],
    limit: ({ min_texels_px }) => min_texels_px,
    shows: [0, 1],
  },
];

const kRobustShare = 0.97;

/** All values, the range that is always shown, and a limit that is not far away. */
export function stripRange(
  strip: Strip,
  samples: MissionSamples,
  limits: MissionLimits,
): [number, number] {
  let [low, high] = strip.shows ?? [Infinity, -Infinity];
  const columns = strip.curves.map(({ values }) => values(samples));
  if (strip.ground === true) columns.push(samples.ground_ellipsoid_m);
  for (const column of columns) {
    const values = column.filter((value) => value !== null).sort((a, b) => a - b);
    const last = strip.robust === true ? Math.floor(kRobustShare * values.length) : values.length;
    low = Math.min(low, values[0] ?? Infinity);
    high = Math.max(high, values[Math.max(0, last - 1)] ?? -Infinity);
  }
  const limit = strip.limit?.(limits);
  if (limit !== undefined && limit <= 2 * high) high = Math.max(high, limit);
  if (!(high > low)) return [low - 1, low + 1];
  const margin = (high - low) * 0.06;
  return [strip.shows === null ? low - margin : low, high + margin];
}
