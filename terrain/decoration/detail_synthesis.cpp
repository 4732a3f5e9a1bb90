#include "terrain/decoration/detail_synthesis.hpp"

#include <algorithm>
#include <cmath>

#include "terrain/decoration/detail_bands.hpp"
#include "terrain/decoration/noise.hpp"

namespace overfly::terrain {
namespace {

/// Largest integer <= value / 2^shift, also of negative values.
int floor_shift(int value, int shift) { return value >> shift; }
int ceil_shift(int value, int shift) { return -((-value) >> shift); }

/// A square of a patch; void beyond the patch's edge.
Patch part_of(const Patch& patch, int left, int top, int side) {
  Patch part = void_patch(side, side);
  const int x_begin = std::max(left, 0);
  const int x_end = std::min(left + side, patch.rgb.width_px);
  for (int y = std::max(top, 0); y < std::min(top + side, patch.rgb.height_px); ++y) {
    const auto count = static_cast<std::size_t>(x_end - x_begin);
    std::copy_n(&patch.rgb.at(x_begin, y), 3 * count, &part.rgb.at(x_begin - left, y - top));
    std::copy_n(&patch.valid.at(x_begin, y), count, &part.valid.at(x_begin - left, y - top));
  }
  return part;
}

}  // namespace

DetailSynthesis::DetailSynthesis(const DetailOptions& options, const DetailStatistics& statistics)
    : decay_(static_cast<float>(statistics.decay)),
      seed_(static_cast<std::uint32_t>(options.seed ^ (options.seed >> 32U)) * 0x9E3779B1U) {
  const int count = static_cast<int>(laplace_.size());
  double mean = 0.0;
  for (int i = 0; i < count; ++i) {
    const double p = (i + 0.5) / count - 0.5;
    laplace_[i] = static_cast<float>(-std::copysign(std::log(1.0 - 2.0 * std::abs(p)), p));
    mean += std::abs(laplace_[i]) / count;
  }
  for (float& value : laplace_) value = static_cast<float>(value / mean);
  const double across = 0.5 * (statistics.band_energy[0] + statistics.band_energy[1]);
  for (int c = 0; c < 3; ++c) {
    const double shape = across > 0.0 ? std::sqrt(statistics.band_energy[c] / across) : 1.0;
    amplitude_[c] = static_cast<float>(options.strength * statistics.contrast_gain * shape);
  }
}

DetailSynthesis::Region DetailSynthesis::base_region(const Tile& parent,
                                                     int finer,
                                                     int col,
                                                     int row) {
  // The texels from which `finer` refinements, each needing one texel around, compute the tile with
  // its border.
  int low = -kTileBorder;
  int high = kTileTexels + kTileBorder;
  for (int octave = 0; octave < finer; ++octave) {
    low = floor_shift(low, 1) - 1;
    high = ceil_shift(high, 1) + 1;
  }
  const int share = kTileTexels >> finer;
  const int mask = (1 << finer) - 1;
  const int left = kTileBorder + (col & mask) * share + low;
  const int top = kTileBorder + (row & mask) * share + low;
  // The contrast needs four more texels, in blocks that begin at even texels.
  constexpr int kLook = 4;
  const int cut_x = (left - kLook) & ~1;
  const int cut_y = (top - kLook) & ~1;
  const int cut_side = (high - low + 2 * kLook + 3) & ~1;
  const Patch around = part_of(parent, cut_x, cut_y, cut_side);
  const ImageBuffer<float> image = luma_of(around);
  const ImageBuffer<float> contrast = local_contrast(block_details(image, block_means(image)));
  Region region(low, low, high - low, high - low);
  for (int y = 0; y < high - low; ++y) {
    for (int x = 0; x < high - low; ++x) {
      const int px = left - cut_x + x;
      const int py = top - cut_y + y;
      region.contrast.at(x, y) = contrast.at(px, py);
      region.valid.at(x, y) = around.valid.at(px, py);
      region.all_valid = region.all_valid && around.valid.at(px, py) != 0;
      for (int c = 0; c < 3; ++c) region.rgb.at(x, y, c) = around.rgb.at(px, py, c);
    }
  }
  return region;
}

DetailSynthesis::Random DetailSynthesis::draw(int x, int y, int octave) const {
  const std::uint32_t bits =
      synthesis::hash(x, y, seed_ + static_cast<std::uint32_t>(octave) * 0x632BE5ABU);
  return {laplace_[bits & 1023U], laplace_[(bits >> 10U) & 1023U], laplace_[bits >> 22U]};
}

void DetailSynthesis::refine_texel(
    const Region& coarse, int x, int y, const Random& random, Region& fine) const {
  const float contrast = coarse.contrast.at(x, y);
  const std::uint8_t valid = coarse.valid.at(x, y);
  float around = 1.0F;  // 0 at the imagery's edge, where the neighbours have no values
  for (int j = coarse.all_valid ? 2 : -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) around *= coarse.valid.at(x + i, y + j) != 0 ? 1.0F : 0.0F;
  }
  const auto at = [&](int i, int j, int c) { return coarse.rgb.at(x + i, y + j, c); };
  float across[3], down[3], diagonal[3];
  float room = 1.0F;  // largest scale of the deviations that keeps every texel within [0, 255]
  for (int c = 0; c < 3; ++c) {
    const float corners = at(-1, -1, c) + at(1, 1, c) - at(1, -1, c) - at(-1, 1, c);
    across[c] = around * (0.125F * (at(1, 0, c) - at(-1, 0, c)) + contrast * random.across);
    down[c] = around * (0.125F * (at(0, 1, c) - at(0, -1, c)) + contrast * random.down);
    diagonal[c] = around * (corners / 64.0F + contrast * random.diagonal);
    // The four deviations are +-h +-v +-x with an even number of minus signs before x.
    const float h = across[c], v = down[c], d = diagonal[c];
    const float top = std::max(std::max(h + v + d, -h - v + d), std::max(h - v - d, v - h - d));
    const float bottom = std::min(std::min(h + v + d, -h - v + d), std::min(h - v - d, v - h - d));
    const float mean = at(0, 0, c);
    if (mean + top > 255.0F) room = std::min(room, (255.0F - mean) / top);
    if (mean + bottom < 0.0F) room = std::min(room, -mean / bottom);
  }
  for (int k = 0; k < 4; ++k) {
    const int px = 2 * (coarse.x + x) + k % 2 - fine.x;
    const int py = 2 * (coarse.y + y) + k / 2 - fine.y;
    if (px < 0 || py < 0 || px >= fine.rgb.width_px || py >= fine.rgb.height_px) continue;
    const float east = k % 2 == 0 ? -room : room;
    const float south = k / 2 == 0 ? -1.0F : 1.0F;
    for (int c = 0; c < 3; ++c) {
      fine.rgb.at(px, py, c) =
          at(0, 0, c) + east * (across[c] + south * diagonal[c]) + south * room * down[c];
    }
    fine.contrast.at(px, py) = decay_ * contrast;
    fine.valid.at(px, py) = valid;
  }
}

DetailSynthesis::Region DetailSynthesis::refined(const Region& coarse,
                                                 int octave,
                                                 const std::array<int, 2>& origin,
                                                 const std::array<int, 4>& wanted) const {
  Region fine(wanted[0], wanted[1], wanted[2], wanted[3]);
  fine.all_valid = coarse.all_valid;
  for (int y = 1; y + 1 < coarse.rgb.height_px; ++y) {
    for (int x = 1; x + 1 < coarse.rgb.width_px; ++x) {
      Random random = draw(origin[0] + coarse.x + x, origin[1] + coarse.y + y, octave);
      random.across *= decay_ * amplitude_[0];
      random.down *= decay_ * amplitude_[1];
      random.diagonal *= decay_ * amplitude_[2];
      refine_texel(coarse, x, y, random, fine);
    }
  }
  return fine;
}

Tile DetailSynthesis::tile(const Tile& parent, int finer, int col, int row) const {
  Region region = base_region(parent, finer, col, row);
  for (int octave = 1; octave <= finer; ++octave) {
    // Coarse texels of this step: the finer tile's corner, and the part to compute.
    const int left = finer - octave + 1;
    const std::array<int, 2> origin{(col * kTileTexels) >> left, (row * kTileTexels) >> left};
    const int low = 2 * (region.x + 1);
    const int side = 2 * (region.rgb.width_px - 2);
    const bool last = octave == finer;
    region = refined(region,
                     octave,
                     origin,
                     last ? std::array<int, 4>{-kTileBorder, -kTileBorder, kTileSide, kTileSide}
                          : std::array<int, 4>{low, low, side, side});
  }
  Tile tile = void_patch(kTileSide, kTileSide);
  tile.valid = std::move(region.valid);
  for (std::size_t i = 0; i < tile.valid.data.size(); ++i) {
    if (tile.valid.data[i] == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      tile.rgb.data[3 * i + c] =
          static_cast<std::uint8_t>(std::floor(region.rgb.data[3 * i + c] + 0.5F));
    }
  }
  return tile;
}

}  // namespace overfly::terrain
