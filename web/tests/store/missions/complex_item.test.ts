import { describe, expect, it } from 'vitest';
import { movedTo } from '../../../src/store/missions/mission_edit';
import { expandedItems, missionFromPlan } from '../../../src/store/missions/plan_file';
import { kPlan, simple } from '../../support/missions';

const [lat_deg, lon_deg] = kPlan.mission.plannedHomePosition as [number, number];
const at = (north_deg: number, east_deg: number) => [lat_deg + north_deg, lon_deg + east_deg];

/** The plan with only this item, moved north by 0.01 deg and east by 0.02 deg. */
function moved(item: object) {
  const plan = { ...kPlan, mission: { ...kPlan.mission, items: [item] } };
  let id = 0;
  const mission = missionFromPlan(plan as never, () => (id += 1));
  const [only] = movedTo(mission, [lat_deg + 0.01, lon_deg + 0.02]).items;
  if (only?.kind !== 'complex') throw new Error('no complex item');
  return only.raw;
}

/** Longitudes are a little farther apart at another latitude. */
function expectNear(place: unknown, [lat = 0, lon = 0]: number[]): void {
  const [movedLat, movedLon] = place as [number, number];
  expect(movedLat).toBeCloseTo(lat, 7);
  expect(movedLon).toBeCloseTo(lon, 5);
}

describe('moving a mission moves', () => {
  it('surveys with their area, transects and items', () => {
    const raw = moved({
      type: 'ComplexItem',
      complexItemType: 'survey',
      angle: 30,
      polygon: [at(0, 0), at(0, 0.01)],
      TransectStyleComplexItem: {
        CameraCalc: { AdjustedFootprintFrontal: 25 },
        Items: [
          simple(16, 3, [0, 0, 0, null, lat_deg, lon_deg + 0.01, 100], 1),
          simple(206, 2, [25, 0, 1, 0, 0, 0, 0], 2),
          simple(16, 3, [0, 0, 0, 0, 0, 0, 50], 3),
        ],
        VisualTransectPoints: [at(0, 0.01)],
      },
    });
    const polygon = raw['polygon'] as number[][];
    expectNear(polygon[0], at(0.01, 0.02));
    expectNear(polygon[1], at(0.01, 0.03));
    const items = expandedItems(raw);
    expectNear(items[0]?.params.slice(4), at(0.01, 0.03));
    expect(items[0]?.params[6]).toBe(100);
    expect(items[1]?.params).toEqual([25, 0, 1, 0, 0, 0, 0]);
    expect(items[2]?.params).toEqual([0, 0, 0, 0, 0, 0, 50]);
    const transect = raw['TransectStyleComplexItem'] as Record<string, unknown>;
    expectNear((transect['VisualTransectPoints'] as unknown[])[0], at(0.01, 0.03));
    expect(transect['CameraCalc']).toEqual({ AdjustedFootprintFrontal: 25 });
    expect(raw['angle']).toBe(30);
  });

  it('corridors and landing patterns', () => {
    const corridor = moved({
      type: 'ComplexItem',
      complexItemType: 'CorridorScan',
      polyline: [at(0, 0), at(0, 0.01)],
    });
    expectNear((corridor['polyline'] as unknown[])[1], at(0.01, 0.03));
    const landing = moved({
      type: 'ComplexItem',
      complexItemType: 'fwLandingPattern',
      landCoordinate: [...at(0, 0), 0],
      landingApproachCoordinate: [...at(0, 0.01), 40],
      loiterRadius: 75,
    });
    expectNear(landing['landCoordinate'], at(0.01, 0.02));
    expectNear(landing['landingApproachCoordinate'], at(0.01, 0.03));
    expect((landing['landingApproachCoordinate'] as number[])[2]).toBe(40);
    expect(landing['loiterRadius']).toBe(75);
  });
});
