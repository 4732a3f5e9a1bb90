// What is wrong with a mission: by kind, each place once.
import type { MissionWarning } from '../../protocol/mission_types';
import { formatNumber } from '../../store/format';

export interface CheckGroup {
  kind: string;
  title: string;
  places: { text: string; hint: string; warning: MissionWarning }[];
}

interface KindInfo {
  title: (limit: number | null) => string;
  unit: string;
  digits: number;
}

const kKinds: Readonly<Record<string, KindInfo>> = {
  clearance: {
    title: (limit) => `Height above the ground below ${limit ?? ''} m`,
    unit: ' m',
    digits: 0,
  },
  bank: { title: (limit) => `Bank above ${limit ?? ''}°`, unit: '°', digits: 0 },
  overlap: { title: (limit) => `Overlap below ${limit ?? ''}`, unit: '', digits: 2 },
  texture: {
    title: (limit) => `Texture-limited: texels per pixel below ${limit ?? ''}`,
    unit: '',
    digits: 2,
  },
  motion: {
    title: (limit) => `Image motion above ${limit ?? ''} px per frame`,
    unit: ' px',
    digits: 0,
  },
  imagery: { title: (limit) => `Share of imagery below ${limit ?? ''}`, unit: '', digits: 2 },
  climb: { title: () => 'The aircraft cannot follow the heights', unit: ' m below', digits: 0 },
  start: { title: () => 'Start for estimators', unit: '', digits: 0 },
  flight: { title: () => 'Flight', unit: '', digits: 0 },
  plan: { title: () => 'Not flown', unit: '', digits: 0 },
};

export function checkGroups(warnings: readonly MissionWarning[]): CheckGroup[] {
  const groups = new Map<string, CheckGroup>();
  for (const warning of warnings) {
    const { kind, limit } = warning;
    // Limits of one kind may differ: the autopilot's and the viewer's.
    const key = `${kind} ${limit ?? ''}`;
    const info = kKinds[kind];
    const title = info?.title(limit) ?? kind;
    const group = groups.get(key) ?? { kind, title, places: [] };
    group.places.push({ text: placeText(warning, info), hint: warning.text, warning });
    groups.set(key, group);
  }
  return [...groups.values()];
}

function placeText(warning: MissionWarning, info: KindInfo | undefined): string {
  const { value, limit, from_s, to_s, item, text } = warning;
  if (value === null || info === undefined) return text;
  // A value that rounds to its limit would look as if it kept it.
  const same = formatNumber(value, info.digits) === formatNumber(limit ?? NaN, info.digits);
  const figure = `${formatNumber(value, info.digits + (same ? 2 : 0))}${info.unit}`;
  if (from_s === null || to_s === null) return `${figure} in the turn of item ${item ?? '?'}`;
  const begin = formatNumber(from_s, 0);
  const end = formatNumber(to_s, 0);
  const when = begin === end ? `at ${begin} s` : `from ${begin} to ${end} s`;
  return item === null ? `${figure} ${when}` : `${figure} ${when}, item ${item}`;
}
