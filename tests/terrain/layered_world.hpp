// A small world of layers with holes in different coordinate systems, written as files.
#pragma once

#include <filesystem>

#include "terrain/world.hpp"

namespace overfly::testing {

/// Easting and northing in UTM zone 16 of the north-west corner of its first layer [m].
inline constexpr double kLayeredLeftM = 583000.0;
inline constexpr double kLayeredTopM = 4357000.0;
/// The hole of the first layer of imagery, in its pixels, half a metre each: [first, last).
inline constexpr int kHoleFirstPx = 300;
inline constexpr int kHoleLastPx = 420;

/// Of one grey level where it is not negative, else textured.
struct LayerColours {
  int first = -1;
  int second = -1;
};

/// Two layers of imagery and two of heights over Indiana, each first one in UTM with a hole, each
/// second one in degrees, coarser and wider; with its manifest world.json, which is returned.
[[nodiscard]] std::filesystem::path write_layered_world(const std::filesystem::path& folder,
                                                        const LayerColours& colours = {});

}  // namespace overfly::testing
