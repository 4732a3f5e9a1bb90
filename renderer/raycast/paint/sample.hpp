// Trilinear samples of a tile over a block of pixels.
#pragma once

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

/// Samples a block.
/// @param out  by plane, then row, then column, kBlockPixels per plane and kBlockSide per row, in
///             the texels' units. Values right of the block are undefined.
using SampleKernel = void (*)(const TexelBlock& block, const PackedTile& tile, float* out);

/// The plain kernel; the other kernels must give the same bits.
void sample_plain(const TexelBlock& block, const PackedTile& tile, float* out);

/// The fastest kernel supported by this machine.
[[nodiscard]] SampleKernel best_sample_kernel();
/// "avx2" or "plain".
[[nodiscard]] const char* name_of(SampleKernel kernel);

}  // namespace overfly::renderer::raycast
