#include <algorithm>
#include <cmath>
#include <vector>

#include "terrain/decoration/detail.hpp"
#include "terrain/decoration/detail_bands.hpp"

namespace overfly::terrain {
namespace {

constexpr int kMostTiles = 16;
constexpr int kBands = 3;

/// Sums of squares over the measured blocks.
struct Sums {
  double square[kBands][3] = {};
  double count[kBands] = {};
  double foretold = 0.0;  ///< prediction of the finest band's mean square from its local contrast
  double foretold_count = 0.0;
};

/// Tiles of level 0 spread evenly over those with imagery, fully covered ones first.
std::vector<TileId> spread_tiles(const TileSource& tiles) {
  const TileGrid& grid = tiles.grid();
  std::vector<TileId> all;
  for (const TileCoverage wanted : {TileCoverage::kFull, TileCoverage::kPartial}) {
    const std::int64_t count = static_cast<std::int64_t>(grid.cols) * grid.rows;
    const std::int64_t step = std::max<std::int64_t>(1, count / 4096);
    for (std::int64_t i = 0; i < count; i += step) {
      const TileId id{0, static_cast<int>(i % grid.cols), static_cast<int>(i / grid.cols)};
      if (tiles.coverage(id) == wanted) all.push_back(id);
    }
    if (!all.empty()) break;
  }
  std::vector<TileId> spread;
  const std::size_t wanted = std::min<std::size_t>(kMostTiles, all.size());
  for (std::size_t i = 0; i < wanted; ++i) {
    spread.push_back(all[(2 * i + 1) * all.size() / (2 * wanted)]);
  }
  return spread;
}

void add_tile(const Tile& tile, Sums& sums) {
  ImageBuffer<float> image = luma_of(tile);
  for (int band = 0; band < kBands; ++band) {
    ImageBuffer<float> means = block_means(image);
    const ImageBuffer<float> details = block_details(image, means);
    for (std::size_t i = 0; i < details.data.size(); i += 3) {
      if (std::isnan(details.data[i])) continue;
      for (int c = 0; c < 3; ++c) {
        sums.square[band][c] += static_cast<double>(details.data[i + c]) * details.data[i + c];
      }
      sums.count[band] += 1.0;
    }
    if (band == 0) {
      // A Laplace variable with mean absolute value b has the mean square 2 b^2.
      for (const float contrast : local_contrast(details).data) {
        sums.foretold += 2.0 * contrast * contrast;
        sums.foretold_count += contrast > 0.0F ? 1.0 : 0.0;
      }
    }
    image = std::move(means);
  }
}

}  // namespace

Result<DetailStatistics> measure_detail(const TileSource& tiles) {
  Sums sums;
  DetailStatistics statistics;
  for (const TileId& id : spread_tiles(tiles)) {
    const auto tile = tiles.tile(id);
    if (!tile) return tile.error();
    add_tile(*tile, sums);
    ++statistics.tiles;
  }
  if (sums.count[0] == 0.0 || sums.count[kBands - 1] == 0.0) return statistics;
  double energy[kBands] = {};
  for (int band = 0; band < kBands; ++band) {
    for (const double square : sums.square[band]) energy[band] += square / sums.count[band];
  }
  for (int c = 0; c < 3; ++c) statistics.band_energy[c] = sums.square[0][c] / sums.count[0];
  if (energy[0] <= 0.0 || sums.foretold_count == 0.0) return statistics;
  // Limits the amplitude, since noise and sharpening can make the finest band the strongest.
  constexpr double kWeakest = 0.25;
  constexpr double kStrongest = 1.0;
  statistics.decay = std::clamp(
      std::pow(energy[0] / energy[kBands - 1], 0.5 / (kBands - 1)), kWeakest, kStrongest);
  const double across = 0.5 * (statistics.band_energy[0] + statistics.band_energy[1]);
  statistics.contrast_gain = std::sqrt(across * sums.foretold_count / sums.foretold);
  return statistics;
}

}  // namespace overfly::terrain
