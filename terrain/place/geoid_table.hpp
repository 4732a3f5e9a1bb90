// Inside terrain only: a coarse EGM96 for machines without PROJ's grids.
#pragma once

namespace overfly::terrain {

inline constexpr int kEgm96TableStepDeg = 5;
/// Error bound of the table against the 15' model for 99 % of the earth; the worst place (a trench)
/// is 23 m off [m].
inline constexpr int kEgm96TableErrorM = 8;

/// Height of EGM96's geoid above WGS84, bilinear in the table [m].
[[nodiscard]] double egm96_table_m(double lat_rad, double lon_rad);

}  // namespace overfly::terrain
