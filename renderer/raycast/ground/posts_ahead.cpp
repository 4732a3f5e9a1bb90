#include "renderer/raycast/ground/posts_ahead.hpp"

#include <algorithm>
#include <limits>

#include "renderer/raycast/cache_line.hpp"

namespace overfly::renderer::raycast {

namespace {

/// Requests a row of posts, both ends included.
void request_row(const HeightTile& tile, int first_column, int last_column, int row) {
  const auto* at = reinterpret_cast<const char*>(&tile.post(first_column, row));
  const auto* last = reinterpret_cast<const char*>(&tile.post(last_column, row) + 1) - 1;
  for (; at < last; at += kCacheLineBytes) request_cache_line(at);
  request_cache_line(last);
}

}  // namespace

void request_between(const std::array<const GroundHit*, 4>& hits) {
  constexpr double kFar = std::numeric_limits<double>::max();
  double west_m = kFar, east_m = -kFar, south_m = kFar, north_m = -kFar;
  for (const GroundHit* hit : hits) {
    if (hit->sky()) continue;
    const GroundNode& node = *hit->node;
    const double at_east_m = node.east_m + hit->column * node.tile->spacing_m;
    const double at_north_m = node.north_m + hit->row * node.tile->spacing_m;
    west_m = std::min(west_m, at_east_m);
    east_m = std::max(east_m, at_east_m);
    south_m = std::min(south_m, at_north_m);
    north_m = std::max(north_m, at_north_m);
  }
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const GroundNode* node = hits[i]->node;
    const auto done = [&](const GroundHit* hit) { return hit->node == node; };
    if (node == nullptr || std::any_of(hits.begin(), hits.begin() + i, done)) continue;
    const HeightTile& tile = *node->tile;
    const auto cell = [&](double from_m) {
      return static_cast<int>(std::clamp<double>(from_m * tile.per_m, 0.0, kTileCells - 1));
    };
    const int first_column = cell(west_m - node->east_m);
    const int last_column = cell(east_m - node->east_m) + 1;
    const int last_row = cell(north_m - node->north_m) + 1;
    for (int row = cell(south_m - node->north_m); row <= last_row; ++row) {
      request_row(tile, first_column, last_column, row);
    }
  }
}

}  // namespace overfly::renderer::raycast
