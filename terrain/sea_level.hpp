// Mean sea level above the ellipsoid.
#pragma once

#include "core/earth/geodesy.hpp"

namespace overfly::terrain {

/// Height of EGM96's geoid above the ellipsoid at a place [m]: by its PROJ grid if that is
/// installed, else by the built-in table (within kEgm96TableErrorM for 99 % of the earth).
[[nodiscard]] double sea_level_m(const Geodetic& place);

}  // namespace overfly::terrain
