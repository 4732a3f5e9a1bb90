#include "terrain/decoration/height_lattice.hpp"

#include <cmath>

#include "terrain/height_errors.hpp"

namespace overfly::terrain {
namespace {

constexpr std::size_t kMostChunks = 4096;  // 64 MiB

}  // namespace

HeightLattice::HeightLattice(std::shared_ptr<const TileSource> tiles, double spacing_m)
    : tiles_(std::move(tiles)), spacing_m_(spacing_m) {}

HeightLattice::~HeightLattice() = default;

Eigen::Vector2d HeightLattice::map_of(int lattice, double i, double j) const {
  const TileGrid& grid = tiles_->grid();
  const double step_m = spacing_m(lattice);
  return {grid.left_x_m + i * step_m, grid.top_y_m - j * step_m};
}

std::uint64_t HeightLattice::key_of(int lattice, int chunk_i, int chunk_j) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 28U) - 1U;
  return (static_cast<std::uint64_t>(lattice) << 56U) |
         ((static_cast<std::uint64_t>(static_cast<std::uint32_t>(chunk_i)) & kMask) << 28U) |
         (static_cast<std::uint64_t>(static_cast<std::uint32_t>(chunk_j)) & kMask);
}

HeightLattice::Heights HeightLattice::read(int lattice, int chunk_i, int chunk_j) const {
  constexpr int kNodes = 1 << kLog2Chunk;
  std::shared_ptr<float[]> heights(new float[static_cast<std::size_t>(kNodes) * kNodes]);
  for (int j = 0; j < kNodes; ++j) {
    for (int i = 0; i < kNodes; ++i) {
      const Eigen::Vector2d map = map_of(lattice, chunk_i * kNodes + i, chunk_j * kNodes + j);
      const Eigen::Vector3d ground =
          lattice == 0 ? tiles_->world_from_map(map.x(), map.y())
                       : tiles_->coarse_world_from_map(map.x(), map.y(), spacing_m(lattice));
      heights[static_cast<std::size_t>(j) * kNodes + i] = static_cast<float>(ground.z());
    }
  }
  return heights;
}

HeightLattice::Heights HeightLattice::get(int lattice, int chunk_i, int chunk_j) const {
  const std::uint64_t key = key_of(lattice, chunk_i, chunk_j);
  {
    const std::lock_guard lock(mutex_);
    const auto found = chunks_.find(key);
    if (found != chunks_.end()) return found->second;
  }
  const HeightErrors errors;
  Heights heights = read(lattice, chunk_i, chunk_j);
  // Heights that could not be read are not kept for others.
  if (!errors.status()) return heights;
  const std::lock_guard lock(mutex_);
  // Readers hold the chunks they use; clearing all is rare and keeps this simple.
  if (chunks_.size() >= kMostChunks) chunks_.clear();
  chunks_.emplace(key, heights);
  return heights;
}

const float* HeightLattice::Reader::chunk(int lattice, int chunk_i, int chunk_j) {
  const std::uint64_t key = key_of(lattice, chunk_i, chunk_j);
  const unsigned place =
      static_cast<unsigned>(chunk_i & 7) | (static_cast<unsigned>(chunk_j & 7) << 3U);
  Slot& slot = slots_[(place + 19U * static_cast<unsigned>(lattice)) & 63U];
  if (slot.key != key) {
    slot.heights = lattice_.get(lattice, chunk_i, chunk_j);
    slot.key = key;
  }
  return slot.heights.get();
}

float HeightLattice::Reader::up_m(int lattice, int i, int j) {
  constexpr int kInside = (1 << kLog2Chunk) - 1;
  const float* heights = chunk(lattice, i >> kLog2Chunk, j >> kLog2Chunk);
  return heights[((j & kInside) << kLog2Chunk) + (i & kInside)];
}

float HeightLattice::Reader::up_m(int lattice, double i, double j) {
  const int i0 = static_cast<int>(std::floor(i));
  const int j0 = static_cast<int>(std::floor(j));
  const auto u = static_cast<float>(i - i0);
  const auto v = static_cast<float>(j - j0);
  const float north = (1.0F - u) * up_m(lattice, i0, j0) + u * up_m(lattice, i0 + 1, j0);
  const float south = (1.0F - u) * up_m(lattice, i0, j0 + 1) + u * up_m(lattice, i0 + 1, j0 + 1);
  return (1.0F - v) * north + v * south;
}

}  // namespace overfly::terrain
