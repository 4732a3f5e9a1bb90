// Trilinear samples of a tile over a block of pixels.
#pragma once

#include <array>
#include <cstdint>

#include "renderer/raycast/paint/blocks.hpp"
#include "renderer/raycast/paint/packed_tile.hpp"

namespace overfly::renderer::raycast {

/// The nearest integer, half up. @param value  >= 0
inline std::int32_t rounded(float value) {
  // NOLINTNEXTLINE(bugprone-incorrect-roundings): correct from 0 up; same as vector code
  return static_cast<std::int32_t>(value + 0.5F);
}

/// Side of the square of pixels that a kernel fills.
inline constexpr int kBlockSide = 16;
inline constexpr int kBlockPixels = kBlockSide * kBlockSide;

/// A block's place in a tile: u = u0 + numerator_u / inverse_depth, in texels of the tile's own
/// level relative to its border's corner.
struct TexelBlock {
  int columns = 0, rows = 0;  ///< at most kBlockSide
  float u0 = 0.0F, v0 = 0.0F;
  Bilinear4 numerator_u{}, numerator_v{}, inverse_depth{};
  Bilinear4 lod{};  ///< of the tile's own level
};

/// Where the samples of a block lie: what a kernel's first step leaves for its second one.
struct SamplePlan {
  /// Of one mip level, by pixel.
  struct Level {
    alignas(32) std::array<std::int32_t, kBlockPixels> element;
    /// Of narrow texels: weights; of wide ones: shares.
    alignas(32) std::array<std::int32_t, kBlockPixels> down;
    alignas(32) std::array<std::int32_t, kBlockPixels> across;
  };
  TexelBlock block;
  const PackedTile* tile = nullptr;
  bool first_mip_only = false;
  Level fine, coarse;
  alignas(32) std::array<float, kBlockPixels> between;  ///< share of the coarse level
};

/// Samples blocks in two steps. Between them the processor reads the texels into its caches: plan
/// the next block before the samples of this one are read.
struct SampleKernel {
  const char* name;
  /// @param tile  must outlive the plan
  void (*plan)(const TexelBlock& block, const PackedTile& tile, SamplePlan& plan);
  /// @param out  by plane, then row, then column, kBlockPixels per plane and kBlockSide per row, in
  ///             the texels' units. Values right of the block are undefined.
  void (*read)(const SamplePlan& plan, float* out);
};

/// The plain kernel; the other kernels must give the same bits.
[[nodiscard]] const SampleKernel& plain_sample_kernel();
/// The fastest kernel supported by this machine.
[[nodiscard]] const SampleKernel& best_sample_kernel();

}  // namespace overfly::renderer::raycast
