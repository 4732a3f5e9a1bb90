// Requests the cache lines of the ground's posts before rays read them. A frame reads several
// megabytes of posts, more than the caches near a core hold.
#pragma once

#include <array>

#include "renderer/raycast/ground/ground_hit.hpp"

namespace overfly::renderer::raycast {

/// Requests the posts between hits, in the tiles of the hits. Tiles between those are left out.
/// @param hits  of the rays through the corners of a part of the image
void request_between(const std::array<const GroundHit*, 4>& hits);

}  // namespace overfly::renderer::raycast
