// Makes the borders of neighbouring patches meet.
#pragma once

#include <vector>

#include "renderer/ground_selection.hpp"

namespace overfly::renderer {

/// Refines leaves where their neighbours need it and sets every border to the coarser cells of
/// the two patches that share it: the mesh has neither gaps nor T-junctions.
/// @param leaves  disjoint patches; log2_cells may grow, log2_border_ratio is set
void stitch_borders(std::vector<GroundLeaf>& leaves);

}  // namespace overfly::renderer
