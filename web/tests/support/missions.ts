// Missions and worlds as the tests use them.
import type { MissionReport, World, WorldEntry } from '../../src/protocol/mission_types';

export const kPlan = {
  fileType: 'Plan',
  version: 1,
  groundStation: 'QGroundControl',
  geoFence: { circles: [], polygons: [{ inclusion: true, polygon: [] }], version: 2 },
  rallyPoints: { points: [[39.35, -86.03, 50]], version: 2 },
  mission: {
    version: 2,
    cruiseSpeed: 15,
    vehicleType: 1,
    firmwareType: 3,
    hoverSpeed: 5,
    globalPlanAltitudeMode: 1,
    plannedHomePosition: [39.355375, -86.030728, 227.7],
    items: [
      simple(22, 3, [15, 0, 0, null, 39.352675, -86.030728, 60], 1, {
        Altitude: 60,
        AltitudeMode: 1,
        AMSLAltAboveTerrain: null,
      }),
      simple(178, 2, [0, 22, -1, 0, 0, 0, 0], 2),
      {
        type: 'ComplexItem',
        complexItemType: 'survey',
        version: 5,
        angle: 30,
        TransectStyleComplexItem: {
          Items: [
            simple(16, 3, [0, 0, 0, null, 39.35, -86.03, 100], 3),
            simple(206, 2, [25, 0, 1, 0, 0, 0, 0], 4),
          ],
          version: 1,
        },
      },
      simple(16, 10, [0, 0, 0, null, 39.346365, -86.024928, 150.5], 5),
      simple(203, 2, [0, 0, 0, 0, 1, 0, 0], 6),
      simple(20, 2, [0, 0, 0, 0, 0, 0, 0], 7),
    ],
  },
};

export function simple(
  command: number,
  frame: number,
  params: (number | null)[],
  doJumpId: number,
  more: Record<string, number | null> = {},
) {
  return { ...more, autoContinue: true, command, doJumpId, frame, params, type: 'SimpleItem' };
}

export const kWaypoints = [
  'QGC WPL 110',
  '0\t1\t0\t16\t0\t0\t0\t0\t39.35537500\t-86.03072800\t227.7\t1',
  '1\t0\t3\t22\t15\t0\t0\t0\t39.35267500\t-86.03072800\t60\t1',
  '2\t0\t10\t18\t2\t0\t-90.5\t0\t39.35267500\t-86.02492800\t150\t1',
  '3\t0\t3\t203\t0\t0\t0\t0\t0.00000000\t0.00000000\t0\t0',
  '',
].join('\n');

export function sampleWorld(change: Partial<World> = {}): World {
  const centre = { lat_deg: 39.35, lon_deg: -86.03, alt_ellipsoid_m: 200 };
  return {
    name: 'builtin:1',
    title: 'Airfield',
    attribution: '',
    world: { builtin: { seed: 1 } },
    version: '0123456789abcdef',
    centre,
    outline: [centre],
    bounds: { west_deg: -86.06, north_deg: 39.37, east_deg: -86.0, south_deg: 39.33 },
    origin: centre,
    runway: { lat_deg: 39.355, lon_deg: -86.031, alt_ellipsoid_m: 195, heading_deg: 180 },
    sea_level_ellipsoid_m: -33,
    texel_m: 0.3,
    tile_px: 256,
    min_zoom: 11,
    max_zoom: 19,
    ...change,
  };
}

export function sampleWorldEntry(change: Partial<WorldEntry> = {}): WorldEntry {
  const world = { builtin: { seed: 1 } };
  return {
    name: 'builtin:1',
    title: 'Airfield',
    world,
    made: true,
    scenarios: ['course'],
    ...change,
  };
}

export function sampleReport(change: Partial<MissionReport> = {}): MissionReport {
  const t_s = [0, 10, 20, 30];
  const zeros = t_s.map(() => 0);
  return {
    end: 'done',
    duration_s: 30,
    distance_m: 750,
    roll_limit_deg: 45,
    camera: 'camera0',
    samples: {
      t_s,
      distance_m: [0, 250, 500, 750],
      lat_deg: [1, 2, 3, 4],
      lon_deg: [5, 6, 7, 8],
      alt_ellipsoid_m: [500, 500, 500, 500],
      ground_ellipsoid_m: [200, 210, 220, 200],
      height_agl_m: [300, 290, 280, 300],
      roll_deg: [0, -40, 0, 0],
      pitch_deg: zeros,
      yaw_deg: zeros,
      airspeed_m_s: zeros,
      ground_speed_m_s: zeros,
      climb_m_s: zeros,
      item: [1, 1, 2, null],
      phase: ['en route', 'en route', 'en route', 'done'],
      overlap: [0.9, 0.5, 0.9, null],
      texels_px: [1.2, 1.2, null, 1.2],
      imagery: [1, 1, 1, 1],
      rotation_px: [0, 12, 0, 0],
      translation_px: [2, 2, 2, 2],
    },
    items: [],
    footprints: [],
    start: null,
    warnings: [],
    ...change,
  };
}
