// Synthetic detail: what it must not change, and how near it comes to real detail.
#include "terrain/decoration/detail.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

#include "terrain/decoration/tile_decorator.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"
#include "tests/terrain/decoration/analytic_tiles.hpp"

namespace overfly::terrain {
namespace {

using testing::TemporaryFolder;

std::shared_ptr<const TileSource> detailed(const std::shared_ptr<const TileSource>& tiles,
                                           const DetailOptions& options) {
  auto result = with_detail(tiles, options);
  if (!result) throw std::runtime_error(result.error().message);
  return *result;
}

class DetailedWorld : public ::testing::Test {
 protected:
  DetailedWorld() {
    testing::SyntheticWorldOptions options;
    options.relief_m = 5.0;
    auto opened = open_world(testing::write_synthetic_world(folder_.path(), options));
    if (!opened) throw std::runtime_error(opened.error().message);
    plain_ = opened->tiles;
    fine_ = detailed(plain_, {.octaves = 2, .strength = 1.0, .seed = 7});
  }
  static Tile read(const TileSource& tiles, const TileId& id) {
    auto tile = tiles.tile(id);
    if (!tile) throw std::runtime_error(tile.error().message);
    return std::move(*tile);
  }
  TemporaryFolder folder_;
  std::shared_ptr<const TileSource> plain_;
  std::shared_ptr<const TileSource> fine_;
};

TEST_F(DetailedWorld, AddsFinerLevelsBelowTheImagery) {
  EXPECT_DOUBLE_EQ(fine_->grid().texel_m, 0.25 * plain_->grid().texel_m);
  EXPECT_DOUBLE_EQ(fine_->real_texel_m(), plain_->grid().texel_m);
  EXPECT_EQ(fine_->grid().levels, plain_->grid().levels + 2);
  for (const TileId& id : {TileId{0, 0, 0}, TileId{0, 2, 1}, TileId{1, 0, 0}}) {
    EXPECT_EQ(read(*fine_, {id.level + 2, id.col, id.row}).rgb.data, read(*plain_, id).rgb.data);
  }
}

TEST_F(DetailedWorld, FinerLevelsAverageToTheImagery) {
  for (int level = 0; level < 2; ++level) {
    const int texels = 4 >> level;
    const TileId id{level, (4 >> level) + 1, (4 >> level) - 1};
    const Tile fine = read(*fine_, id);
    const Tile base = read(*plain_, {0, id.col / texels, id.row / texels});
    const int left = kTileBorder + (id.col % texels) * kTileTexels / texels;
    const int top = kTileBorder + (id.row % texels) * kTileTexels / texels;
    double worst = 0.0;
    for (int y = 0; y < kTileTexels / texels; ++y) {
      for (int x = 0; x < kTileTexels / texels; ++x) {
        for (int c = 0; c < 3; ++c) {
          double mean = 0.0;
          for (int k = 0; k < texels * texels; ++k) {
            mean += fine.rgb.at(
                kTileBorder + texels * x + k % texels, kTileBorder + texels * y + k / texels, c);
          }
          mean /= texels * texels;
          worst = std::max(worst, std::abs(mean - base.rgb.at(left + x, top + y, c)));
        }
      }
    }
    EXPECT_LE(worst, 1.0) << "level " << level;
    EXPECT_GT(worst, 0.0) << "level " << level;
  }
}

TEST_F(DetailedWorld, NeighboursAgreeInTheirBordersExactly) {
  // Tiles within one of the imagery's, and on both sides of its seam.
  for (const TileId& id : {TileId{0, 1, 1}, TileId{0, 3, 3}, TileId{1, 1, 1}}) {
    const Tile tile = read(*fine_, id);
    const Tile east = read(*fine_, {id.level, id.col + 1, id.row});
    const Tile south = read(*fine_, {id.level, id.col, id.row + 1});
    int different = 0;
    for (int along = 0; along < kTileSide; ++along) {
      for (int across = 0; across < 2 * kTileBorder; ++across) {
        for (int c = 0; c < 3; ++c) {
          different += tile.rgb.at(kTileTexels + across, along, c) != east.rgb.at(across, along, c);
          different +=
              tile.rgb.at(along, kTileTexels + across, c) != south.rgb.at(along, across, c);
        }
      }
    }
    EXPECT_EQ(different, 0) << "level " << id.level << " column " << id.col;
  }
}

TEST_F(DetailedWorld, TheSameSeedGivesTheSameTexelsAnotherSeedOthers) {
  const Tile once = read(*fine_, {0, 2, 2});
  EXPECT_EQ(read(*detailed(plain_, {.octaves = 2, .strength = 1.0, .seed = 7}), {0, 2, 2}).rgb.data,
            once.rgb.data);
  EXPECT_NE(read(*detailed(plain_, {.octaves = 2, .strength = 1.0, .seed = 8}), {0, 2, 2}).rgb.data,
            once.rgb.data);
}

TEST_F(DetailedWorld, BeyondTheImageryThereIsNothing) {
  const Tile rim = read(*fine_, {0, 9, 9});
  int voids = 0;
  for (std::size_t i = 0; i < rim.valid.data.size(); ++i) {
    if (rim.valid.data[i] != 0) continue;
    ++voids;
    ASSERT_EQ(rim.rgb.data[3 * i], kVoidRgb[0]);
  }
  EXPECT_GT(voids, 1000);
  EXPECT_EQ(fine_->coverage({0, -1, 0}), TileCoverage::kNone);
  EXPECT_EQ(fine_->coverage({0, 40, 0}), TileCoverage::kNone);
}

TEST(Detail, LeavesSmoothImageryWithoutNoise) {
  // A ramp has contrast from texel to texel, and no texture.
  const auto ramp = std::make_shared<testing::AnalyticTiles>(
      1.0,
      1,
      [](double, double) { return 0.0; },
      Eigen::Vector2d(0.0, 0.0),
      [](int column, int) { return column / 4 + 40; });
  const auto fine = detailed(ramp, {.octaves = 1, .strength = 1.0, .seed = 1});
  const auto tile = fine->tile({0, 0, 0});
  ASSERT_TRUE(tile);
  for (int x = 8; x < 500; ++x) {
    ASSERT_NEAR(tile->rgb.at(kTileBorder + x, 100), x / 8 + 40, 1.5) << x;
  }
}

TEST(Detail, NamesTheFieldThatIsOutOfItsLimits) {
  EXPECT_NE(DetailOptions{.octaves = 9}.validate().error().message.find("detail.octaves = 9"),
            std::string::npos);
  EXPECT_NE(DetailOptions{.strength = -1.0}.validate().error().message.find("detail.strength = -1"),
            std::string::npos);
}

/// Level n of other tiles as level 0.
class ReducedTiles final : public TileDecorator {
 public:
  ReducedTiles(const std::shared_ptr<const TileSource>& base, int levels)
      : TileDecorator(base), levels_(levels), grid_(base->grid()) {
    grid_.texel_m *= 1 << levels;
    grid_.levels -= levels;
    grid_.cols = (grid_.cols + (1 << levels) - 1) >> levels;
    grid_.rows = (grid_.rows + (1 << levels) - 1) >> levels;
  }
  [[nodiscard]] const TileGrid& grid() const override { return grid_; }
  [[nodiscard]] double real_texel_m() const override { return grid_.texel_m; }
  [[nodiscard]] TileCoverage coverage(const TileId& id) const override {
    return base().coverage({id.level + levels_, id.col, id.row});
  }
  [[nodiscard]] Result<Tile> read_tile(const TileId& id,
                                       const Cancelled& cancelled) const override {
    return base().tile({id.level + levels_, id.col, id.row}, cancelled);
  }

 private:
  int levels_;
  TileGrid grid_;
};

cv::Mat grey_of(const Tile& tile) {
  cv::Mat grey(kTileTexels, kTileTexels, CV_32F);
  for (int y = 0; y < kTileTexels; ++y) {
    for (int x = 0; x < kTileTexels; ++x) {
      const std::uint8_t* rgb = &tile.rgb.at(kTileBorder + x, kTileBorder + y);
      grey.at<float>(y, x) = 0.299F * rgb[0] + 0.587F * rgb[1] + 0.114F * rgb[2];
    }
  }
  return grey;
}

/// Mean power at each radius [cycles a tile], Hann window.
using Spectrum = std::array<double, kTileTexels / 2 + 1>;
void add_spectrum(const cv::Mat& grey, Spectrum& spectrum) {
  cv::Mat windowed = grey - cv::mean(grey)[0];
  for (int y = 0; y < kTileTexels; ++y) {
    for (int x = 0; x < kTileTexels; ++x) {
      const double hann =
          std::sin(M_PI * (x + 0.5) / kTileTexels) * std::sin(M_PI * (y + 0.5) / kTileTexels);
      windowed.at<float>(y, x) *= static_cast<float>(hann * hann);
    }
  }
  cv::Mat transform;
  cv::dft(windowed, transform, cv::DFT_COMPLEX_OUTPUT);
  Spectrum sum{};
  Spectrum count{};
  for (int y = 0; y < kTileTexels; ++y) {
    for (int x = 0; x < kTileTexels; ++x) {
      const int fx = x <= kTileTexels / 2 ? x : x - kTileTexels;
      const int fy = y <= kTileTexels / 2 ? y : y - kTileTexels;
      const auto radius = static_cast<std::size_t>(std::lround(std::hypot(fx, fy)));
      if (radius < 1 || radius >= sum.size()) continue;
      const auto value = transform.at<cv::Vec2f>(y, x);
      sum[radius] += value[0] * value[0] + value[1] * value[1];
      count[radius] += 1.0;
    }
  }
  for (std::size_t r = 1; r < sum.size(); ++r) spectrum[r] += sum[r] / count[r];
}

/// Slope of the spectrum in double logarithmic coordinates.
double slope(const Spectrum& spectrum, int from, int to) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int r = from; r <= to; ++r) {
    const double x = std::log(r);
    const double y = std::log(spectrum[static_cast<std::size_t>(r)]);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

double corners(const cv::Mat& grey, int threshold) {
  cv::Mat bytes;
  grey.convertTo(bytes, CV_8U);
  std::vector<cv::KeyPoint> points;
  cv::FAST(bytes, points, threshold, true);
  return static_cast<double>(points.size());
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

TEST(Detail, ComesNearToTheDetailOfARealPhotograph) {
  OVERFLY_DATA_OR_SKIP(file, "terrain/autzen/ortho_0.3m_utm10.tif");
  WorldSpec spec;
  spec.imagery.push_back({file, "", {}});
  spec.ground_height_m = 100.0;
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  // The photograph of 0.3 m is reduced to 1.2 m; two octaves must bring back what was lost.
  const auto reduced = std::make_shared<ReducedTiles>(world->tiles, 2);
  const auto synthetic = detailed(reduced, {.octaves = 2, .strength = 1.0, .seed = 1});
  const auto smooth = detailed(reduced, {.octaves = 2, .strength = 0.0, .seed = 1});
  const TileSource* sources[3] = {world->tiles.get(), synthetic.get(), smooth.get()};
  Spectrum spectra[3] = {};
  std::vector<double> fast[3];
  for (int row = 1; row < 8; row += 2) {
    for (int col = 1; col < 6; col += 2) {
      for (int k = 0; k < 3; ++k) {
        const auto tile = sources[k]->tile({0, col, row});
        ASSERT_TRUE(tile);
        const cv::Mat grey = grey_of(*tile);
        add_spectrum(grey, spectra[k]);
        fast[k].push_back(corners(grey, 7));
      }
    }
  }
  const double real_slope = slope(spectra[0], 64, 240);
  const double synthetic_slope = slope(spectra[1], 64, 240);
  std::printf(
      "spectrum slope above the reduced imagery's limit: real %.2f, synthetic %.2f, without %.2f\n",
      real_slope,
      synthetic_slope,
      slope(spectra[2], 64, 240));
  std::printf("FAST corners a tile, threshold 7: real %.0f, synthetic %.0f, without %.0f\n",
              median(fast[0]),
              median(fast[1]),
              median(fast[2]));
  EXPECT_NEAR(synthetic_slope, real_slope, 0.6);
  EXPECT_GT(median(fast[1]), 0.5 * median(fast[0]));
  EXPECT_LT(median(fast[1]), 2.0 * median(fast[0]));
  EXPECT_LT(median(fast[2]), 0.3 * median(fast[0]));
}

}  // namespace
}  // namespace overfly::terrain
