// What the 3D view shows and from where: its modes, viewpoints and switches, and their text in an
// address.
import type { PoseValues, SceneMode, ScenePart } from '../../protocol/messages';

export interface SceneOrbit {
  azimuth_deg: number;
  elevation_deg: number;
  distance_m: number;
  follow: boolean;
}

/** A place in the world frame of the main run. */
export interface SceneEye {
  x_m: number;
  y_m: number;
  z_m: number;
}

export interface SceneLook {
  mode: SceneMode;
  /** The viewpoint of each mode. */
  orbits: Record<SceneMode, SceneOrbit>;
  /** Of the mode `free`. */
  eye: SceneEye;
  show: ReadonlySet<ScenePart>;
}

export const kSceneModes: readonly { mode: SceneMode; label: string; hint: string; key: string }[] =
  [
    { mode: 'chase', label: 'Chase', hint: 'From behind the aircraft', key: '1' },
    { mode: 'orbit', label: 'Orbit', hint: 'Around the aircraft or the flight', key: '2' },
    { mode: 'top', label: 'Top', hint: 'Straight down', key: '3' },
    { mode: 'onboard', label: 'Onboard', hint: 'Ahead from the cockpit', key: '4' },
    { mode: 'free', label: 'Free', hint: 'Flown with W A S D, Q and E and the mouse', key: '5' },
  ];

export const kSceneParts: readonly { part: ScenePart; label: string; hint: string }[] = [
  { part: 'aircraft', label: 'Aircraft', hint: 'The aircraft, and its ghosts where estimates are' },
  { part: 'ribbons', label: 'Tracks', hint: 'The paths as banked ribbons' },
  { part: 'labels', label: 'Labels', hint: 'Names of runs and estimators at the aircraft' },
  { part: 'errors', label: 'Errors now', hint: 'Lines from the truth to the estimates' },
  {
    part: 'error_history',
    label: 'Errors along the path',
    hint: 'Such lines along the path flown so far',
  },
  { part: 'points', label: 'Map points', hint: 'Points of the estimators’ maps' },
  { part: 'frustum', label: 'View of the camera', hint: 'From the camera to the corners it sees' },
  { part: 'footprint', label: 'Footprint', hint: 'Outline of the camera’s image on the ground' },
  {
    part: 'image',
    label: 'Camera image on the ground',
    hint: 'Each pixel where the camera sees it',
  },
];

export const kUsualParts: readonly ScenePart[] = [
  'aircraft',
  'ribbons',
  'labels',
  'errors',
  'points',
  'frustum',
  'footprint',
];

export function usualLook(): SceneLook {
  const ahead = { distance_m: 120, follow: true };
  return {
    mode: 'chase',
    orbits: {
      chase: { azimuth_deg: 20, elevation_deg: 18, distance_m: 40, follow: true },
      orbit: { azimuth_deg: 215, elevation_deg: 35, distance_m: 900, follow: true },
      top: { azimuth_deg: 0, elevation_deg: 90, distance_m: 2400, follow: false },
      onboard: { azimuth_deg: 0, elevation_deg: -12, ...ahead },
      free: { azimuth_deg: 0, elevation_deg: -30, ...ahead },
    },
    eye: { x_m: 0, y_m: 0, z_m: 300 },
    show: new Set(kUsualParts),
  };
}

const kDistanceRange_m = [5, 20000] as const;
const kFarthest_m = 1e6;
/** Of the viewpoint above the horizon; in the last two modes of the line of sight. */
const kElevationRange_deg: Record<SceneMode, readonly [number, number]> = {
  chase: [-10, 90],
  orbit: [-10, 90],
  top: [90, 90],
  onboard: [-90, 90],
  free: [-90, 90],
};

/** The viewpoint within its limits. */
export function limited(mode: SceneMode, orbit: SceneOrbit): SceneOrbit {
  return {
    azimuth_deg: ((orbit.azimuth_deg % 360) + 360) % 360,
    elevation_deg: clamp(orbit.elevation_deg, kElevationRange_deg[mode]),
    distance_m: clamp(orbit.distance_m, kDistanceRange_m),
    follow: orbit.follow,
  };
}

export function limitedEye({ x_m, y_m, z_m }: SceneEye): SceneEye {
  const within = (value: number) => clamp(value, [-kFarthest_m, kFarthest_m]);
  return { x_m: within(x_m), y_m: within(y_m), z_m: within(z_m) };
}

/**
 * Where the viewer is now, to fly on from there.
 * @param aircraft  of the main run
 * @param centre  of its flight, for views that do not follow
 */
export function freeFrom(
  { mode, orbits, eye }: SceneLook,
  aircraft: PoseValues | null,
  centre: SceneEye,
): { eye: SceneEye; orbit: SceneOrbit } {
  const orbit = orbits[mode];
  const free = { ...orbits.free };
  if (mode === 'free') return { eye, orbit: free };
  const { azimuth_deg, elevation_deg, distance_m } = orbit;
  const target = orbit.follow && aircraft !== null ? aircraft : centre;
  if (mode === 'onboard') {
    if (aircraft === null) return { eye: centre, orbit: free };
    return {
      eye: { x_m: aircraft.x_m, y_m: aircraft.y_m, z_m: aircraft.z_m + 1 },
      orbit: limited('free', {
        ...free,
        azimuth_deg: aircraft.yaw_deg + azimuth_deg,
        elevation_deg: aircraft.pitch_deg + elevation_deg,
      }),
    };
  }
  // The viewpoint lies in this direction from the target (renderer/viewpoint.cpp).
  const compass_deg = mode === 'chase' ? azimuth_deg + (aircraft?.yaw_deg ?? 0) + 180 : azimuth_deg;
  const up = mode === 'top' ? 1 : Math.sin(radians(elevation_deg));
  const level = mode === 'top' ? 0 : Math.cos(radians(elevation_deg));
  return {
    eye: limitedEye({
      x_m: target.x_m + distance_m * level * Math.sin(radians(compass_deg)),
      y_m: target.y_m + distance_m * level * Math.cos(radians(compass_deg)),
      z_m: target.z_m + distance_m * up,
    }),
    orbit: limited('free', {
      ...free,
      azimuth_deg: mode === 'top' ? azimuth_deg : compass_deg + 180,
      elevation_deg: mode === 'top' ? -90 : -elevation_deg,
    }),
  };
}

/** Moves the viewpoint along and across its line of sight, and up. */
export function flown(
  eye: SceneEye,
  { azimuth_deg, elevation_deg }: SceneOrbit,
  { ahead_m, right_m, up_m }: { ahead_m: number; right_m: number; up_m: number },
): SceneEye {
  const [azimuth, elevation] = [radians(azimuth_deg), radians(elevation_deg)];
  const level_m = ahead_m * Math.cos(elevation);
  return limitedEye({
    x_m: eye.x_m + level_m * Math.sin(azimuth) + right_m * Math.cos(azimuth),
    y_m: eye.y_m + level_m * Math.cos(azimuth) - right_m * Math.sin(azimuth),
    z_m: eye.z_m + ahead_m * Math.sin(elevation) + up_m,
  });
}

// ---- in an address -------------------------------------------------------------------------------

/**
 * "MODE,AZIMUTH,ELEVATION,DISTANCE[,fixed]", free: "free,AZIMUTH,ELEVATION,X,Y,Z"; '' for the usual
 * viewpoint.
 */
export function viewText({ mode, orbits, eye }: SceneLook): string {
  const orbit = orbits[mode];
  const usual = usualLook();
  const angles = [orbit.azimuth_deg.toFixed(1), orbit.elevation_deg.toFixed(1)];
  if (mode === 'free') {
    return [mode, ...angles, ...[eye.x_m, eye.y_m, eye.z_m].map((m) => m.toFixed(1))].join();
  }
  const text = [mode, ...angles, orbit.distance_m.toFixed(0), ...(orbit.follow ? [] : ['fixed'])];
  const same = mode === usual.mode && viewKey(orbit) === viewKey(usual.orbits[mode]);
  return same ? '' : text.join();
}

function viewKey({ azimuth_deg, elevation_deg, distance_m, follow }: SceneOrbit): string {
  return [azimuth_deg.toFixed(1), elevation_deg.toFixed(1), distance_m.toFixed(0), follow].join();
}

/** Parts separated by commas; '' for the usual ones, 'none' for none. */
export function showText({ show }: Pick<SceneLook, 'show'>): string {
  const parts = kSceneParts.map(({ part }) => part).filter((part) => show.has(part));
  const usual = parts.length === kUsualParts.length && kUsualParts.every((part) => show.has(part));
  return usual ? '' : parts.length === 0 ? 'none' : parts.join();
}

/** The look of an address; what it lacks, or what is no look, is as usual. */
export function lookFrom(view: string, show: string): SceneLook {
  const look = usualLook();
  const [name = '', ...rest] = view.split(',');
  const mode = kSceneModes.find((known) => known.mode === name)?.mode;
  const numbers = rest.filter((text) => text !== 'fixed').map(Number);
  const good = numbers.length >= 3 && numbers.every(Number.isFinite);
  const [azimuth_deg = 0, elevation_deg = 0, distance_m = 0, y_m = 0, z_m = 0] = numbers;
  if (mode !== undefined && good) {
    look.mode = mode;
    const free = mode === 'free';
    const orbit = { ...look.orbits[mode], azimuth_deg, elevation_deg };
    if (!free) {
      orbit.distance_m = distance_m;
      orbit.follow = !rest.includes('fixed');
    }
    look.orbits[mode] = limited(mode, orbit);
    if (free) look.eye = limitedEye({ x_m: distance_m, y_m, z_m });
  }
  if (show === '') return look;
  const names = show.split(',');
  const parts = kSceneParts.map(({ part }) => part).filter((part) => names.includes(part));
  return { ...look, show: new Set(parts) };
}

function radians(degrees: number): number {
  return (degrees * Math.PI) / 180;
}

function clamp(value: number, [low, high]: readonly [number, number]): number {
  return Math.min(high, Math.max(low, value));
}
