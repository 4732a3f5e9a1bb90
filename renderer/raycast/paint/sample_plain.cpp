#include <algorithm>
#include <cstdint>

#include "renderer/raycast/paint/sample.hpp"
#include "renderer/raycast/paint/sample_weights.hpp"

namespace overfly::renderer::raycast {

namespace {

/// The position of one bilinear sample.
struct Footprint {
  std::int32_t element;
  float across, down;  // in [0, 1)
};

float clamped(float value, float last) {
  const float above = value > 0.0F ? value : 0.0F;
  return above < last ? above : last;
}

Footprint footprint(const PackedTile& tile, int mip, float u, float v) {
  const float s = clamped(u * tile.scale_x[mip] - 0.5F, tile.last_x[mip]);
  const float t = clamped(v * tile.scale_y[mip] - 0.5F, tile.last_y[mip]);
  const auto column = static_cast<std::int32_t>(s);
  const auto row = static_cast<std::int32_t>(t);
  return {tile.offset[mip] + row * tile.stride[mip] + column,
          s - static_cast<float>(column),
          t - static_cast<float>(row)};
}

float narrow_sample(const std::uint16_t* pairs, const Footprint& at) {
  const std::int32_t west = pairs[at.element];
  const std::int32_t east = pairs[at.element + 1];
  const auto down = rounded(at.down * static_cast<float>(kRowOne));
  const auto across = rounded(at.across * static_cast<float>(kColumnOne));
  const std::int32_t left = (west & 255) * (kRowOne - down) + (west >> 8) * down;
  const std::int32_t right = (east & 255) * (kRowOne - down) + (east >> 8) * down;
  return static_cast<float>(left * (kColumnOne - across) + right * across) * kPerProduct;
}

float wide_sample(const std::uint32_t* pairs, const Footprint& at) {
  const std::uint32_t west = pairs[at.element];
  const std::uint32_t east = pairs[at.element + 1];
  const auto low = [](std::uint32_t pair) {
    return static_cast<float>(static_cast<std::int32_t>(pair & 65535U));
  };
  const auto high = [](std::uint32_t pair) {
    return static_cast<float>(static_cast<std::int32_t>(pair >> 16U));
  };
  const float left = low(west) + at.down * (high(west) - low(west));
  const float right = low(east) + at.down * (high(east) - low(east));
  return left + at.across * (right - left);
}

void plan_plain(const TexelBlock& block, const PackedTile& tile, SamplePlan& plan) {
  plan.block = block;
  plan.tile = &tile;
}

void read_plain(const SamplePlan& plan, float* out) {
  const TexelBlock& block = plan.block;
  const PackedTile& tile = *plan.tile;
  const auto value = [](const Bilinear4& f, float x, float y) {
    return (f[0] + f[2] * y) + (f[1] + f[3] * y) * x;
  };
  for (int row = 0; row < block.rows; ++row) {
    const auto y = static_cast<float>(row);
    for (int column = 0; column < block.columns; ++column) {
      const auto x = static_cast<float>(column);
      const float depth = 1.0F / value(block.inverse_depth, x, y);
      const float u = block.u0 + value(block.numerator_u, x, y) * depth;
      const float v = block.v0 + value(block.numerator_v, x, y) * depth;
      const float lod = clamped(value(block.lod, x, y), static_cast<float>(kPackedMips - 1));
      const auto mip = static_cast<int>(lod);
      const float between = lod - static_cast<float>(mip);
      const Footprint fine = footprint(tile, mip, u, v);
      const Footprint coarse = footprint(tile, std::min(mip + 1, kPackedMips - 1), u, v);
      for (int plane = 0; plane < tile.planes; ++plane) {
        const std::size_t first = plane * tile.plane_elements;
        float a = 0.0F, b = 0.0F;
        if (tile.wide) {
          a = wide_sample(&tile.wide_pairs[first], fine);
          b = wide_sample(&tile.wide_pairs[first], coarse);
        } else {
          a = narrow_sample(&tile.pairs[first], fine);
          b = narrow_sample(&tile.pairs[first], coarse);
        }
        out[plane * kBlockPixels + row * kBlockSide + column] = a + between * (b - a);
      }
    }
  }
}

}  // namespace

const SampleKernel& plain_sample_kernel() {
  static constexpr SampleKernel kKernel{"plain", plan_plain, read_plain};
  return kKernel;
}

}  // namespace overfly::renderer::raycast
