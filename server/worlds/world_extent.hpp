// Where a world lies on the earth.
#pragma once

#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "terrain/world.hpp"

namespace overfly::server {

struct WorldExtent {
  std::string name;
  std::string attribution;
  /// Of the imagery's rectangle, on the ground: where a flight is moved to by default.
  Geodetic centre;
  /// The rectangle clockwise from its north-west corner, with points along its sides.
  std::vector<Geodetic> outline;
};

/// Reads heights, which may touch the disk.
[[nodiscard]] WorldExtent extent_of(const terrain::World& world);

}  // namespace overfly::server
