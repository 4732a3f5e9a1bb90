import { expect, it } from 'vitest';
import { homeOf } from '../../../src/store/missions/mission_document';
import { sampleWorld } from '../../support/missions';

it('home lies where the server puts it, on the ellipsoid', () => {
  const document = { flight: { mission: { home: { east_m: 2000, north_m: 3000 } } } };
  const [lat_deg, lon_deg] = homeOf(document, sampleWorld()) ?? [0, 0];
  // From the local frame at 39.35, -86.03, 200 m by Earth-centred coordinates of WGS84.
  expect(lat_deg).toBeCloseTo(39.377018, 5);
  expect(lon_deg).toBeCloseTo(-86.006789, 5);
});
