// Degrees of latitude and longitude as metres.

/** Of WGS84 [m]; the radii of curvature follow from them. */
const kSemiMajor_m = 6378137;
const kEccentricitySquared = 6.69437999014e-3;
const kRadPerDeg = Math.PI / 180;
/** At the poles a degree of longitude has no length, by which nothing can be divided. */
const kLeastCosine = 0.01;

/** Metres per degree of latitude and of longitude at a latitude. */
export function metresPerDegree(lat_deg: number): { north: number; east: number } {
  const sine = Math.sin(lat_deg * kRadPerDeg);
  const w = 1 - kEccentricitySquared * sine * sine;
  const meridian_m = (kSemiMajor_m * (1 - kEccentricitySquared)) / Math.pow(w, 1.5);
  const normal_m = kSemiMajor_m / Math.sqrt(w);
  const cosine = Math.max(kLeastCosine, Math.cos(lat_deg * kRadPerDeg));
  return { north: meridian_m * kRadPerDeg, east: normal_m * cosine * kRadPerDeg };
}
