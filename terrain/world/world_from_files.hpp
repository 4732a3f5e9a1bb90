// A world of raster files without a manifest.
#pragma once

#include <filesystem>
#include <vector>

#include "core/result.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

/// Creates a world from files. Imagery and elevation are distinguished by content: elevation has
/// one band that is not 8 bit; imagery has colours or 8 bits. Layers of either kind are sorted from
/// fine to coarse.
/// Errors: kInvalidArgument naming a file that could be both (one band of 16-bit whole numbers
/// without a unit), or if there is no imagery; kNotFound; kUnreadable.
[[nodiscard]] Result<WorldSpec> world_from_files(const std::vector<std::filesystem::path>& files);

}  // namespace overfly::terrain
