// Divides the patches of a view into the squares of the mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/ground/ground_corners.hpp"
#include "renderer/ground/ground_selection.hpp"

namespace overfly::renderer {

/// A square of 2^t cells of a patch, its north-west corner at (column, row) in cells.
struct GroundSquare {
  std::uint8_t t = 0;
  std::uint8_t column = 0;
  std::uint8_t row = 0;
};

/// The squares of one patch, as large as the limits allow at their place.
/// @param corners  gets every point of a side that becomes a corner by a division, and the corners
///                 on the patch's rim
[[nodiscard]] std::vector<GroundSquare> divide_into_squares(const GroundLeaf& leaf,
                                                            const MeshLimits& limits,
                                                            GroundCorners& corners);

/// Adds the corners created by dividing a patch into four.
void add_division(const GroundPatch& patch, GroundCorners& corners);

}  // namespace overfly::renderer
