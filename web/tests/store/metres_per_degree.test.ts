import { expect, it } from 'vitest';
import { metresPerDegree } from '../../src/store/metres_per_degree';

it('knows the lengths of degrees on the ellipsoid', () => {
  // Lengths of a degree at 45 deg north: 111131.75 m and 78846.81 m (NIMA TR8350.2's ellipsoid).
  const { north, east } = metresPerDegree(45);
  expect(north).toBeCloseTo(111131.75, 0);
  expect(east).toBeCloseTo(78846.81, 0);
  expect(metresPerDegree(90).east).toBeGreaterThan(0);
});
