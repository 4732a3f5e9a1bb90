// Is the built-in world as rich for a tracker as a photograph? Compared with the Autzen photo at
// the same resolution: the slope of the radial power spectrum, and the density of FAST corners
// (Rosten and Drummond, 2006), crop by crop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <vector>

#include "terrain/raster/image_file.hpp"
#include "terrain/synthesis/landscape/painter.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"

namespace overfly::terrain {
namespace {

constexpr int kCropPx = 256;
constexpr double kTexelM = 0.3;

struct Statistics {
  double slope = 0.0;       ///< of log power over log frequency
  double corners_20 = 0.0;  ///< median count per crop at threshold 20
  double corners_7 = 0.0;
  double poorest_7 = 0.0;  ///< 5th percentile
};

cv::Mat grey_levels_of(const Image& rgb) {
  cv::Mat grey(rgb.height_px, rgb.width_px, CV_8U);
  for (int y = 0; y < rgb.height_px; ++y) {
    for (int x = 0; x < rgb.width_px; ++x) {
      const double level =
          0.299 * rgb.at(x, y, 0) + 0.587 * rgb.at(x, y, 1) + 0.114 * rgb.at(x, y, 2);
      grey.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(std::lround(level));
    }
  }
  return grey;
}

/// Power by radial frequency (cycles per crop), Hann-windowed, added to `power`.
void add_radial_spectrum(const cv::Mat& grey,
                         std::vector<double>& power,
                         std::vector<double>& count) {
  cv::Mat windowed(kCropPx, kCropPx, CV_64F);
  const double mean = cv::mean(grey)[0];
  for (int y = 0; y < kCropPx; ++y) {
    for (int x = 0; x < kCropPx; ++x) {
      const double hann = 0.25 * (1 - std::cos(2 * CV_PI * (x + 0.5) / kCropPx)) *
                          (1 - std::cos(2 * CV_PI * (y + 0.5) / kCropPx));
      windowed.at<double>(y, x) = hann * (grey.at<std::uint8_t>(y, x) - mean);
    }
  }
  cv::Mat transformed;
  cv::dft(windowed, transformed, cv::DFT_COMPLEX_OUTPUT);
  for (int y = 0; y < kCropPx; ++y) {
    for (int x = 0; x < kCropPx; ++x) {
      const int fx = x <= kCropPx / 2 ? x : x - kCropPx;
      const int fy = y <= kCropPx / 2 ? y : y - kCropPx;
      const auto radius = static_cast<std::size_t>(std::lround(std::hypot(fx, fy)));
      if (radius == 0 || radius >= power.size()) continue;
      const auto& value = transformed.at<cv::Vec2d>(y, x);
      power[radius] += value[0] * value[0] + value[1] * value[1];
      count[radius] += 1.0;
    }
  }
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

Statistics measure(const std::vector<Image>& crops) {
  std::vector<double> power(kCropPx / 2, 0.0);
  std::vector<double> count(kCropPx / 2, 0.0);
  std::vector<double> corners_20;
  std::vector<double> corners_7;
  for (const Image& crop : crops) {
    const cv::Mat grey = grey_levels_of(crop);
    add_radial_spectrum(grey, power, count);
    std::vector<cv::KeyPoint> corners;
    cv::FAST(grey, corners, 20, true);
    corners_20.push_back(static_cast<double>(corners.size()));
    cv::FAST(grey, corners, 7, true);
    corners_7.push_back(static_cast<double>(corners.size()));
  }
  // Least squares over 4 ... 90 cycles per crop, equal weight per octave.
  double n = 0;
  double sx = 0;
  double sy = 0;
  double sxx = 0;
  double sxy = 0;
  for (std::size_t f = 4; f <= 90; ++f) {
    const double weight = 1.0 / static_cast<double>(f);
    const double x = std::log(static_cast<double>(f));
    const double y = std::log(power[f] / count[f]);
    n += weight;
    sx += weight * x;
    sy += weight * y;
    sxx += weight * x * x;
    sxy += weight * x * y;
  }
  return {(n * sxy - sx * sy) / (n * sxx - sx * sx),
          percentile(corners_20, 0.5),
          percentile(corners_7, 0.5),
          percentile(corners_7, 0.05)};
}

/// Crops on a regular lattice over the middle of the world, painted as the world's files are.
std::vector<Image> synthetic_crops(std::uint32_t seed) {
  synthesis::LandscapeOptions options;
  options.seed = seed;
  options.reach_m = 100.0F;
  const synthesis::Landscape land = synthesis::Landscape::plan(options);
  std::vector<Image> crops;
  constexpr int kSamples = 8;
  for (int j = 0; j < kSamples; ++j) {
    for (int i = 0; i < kSamples; ++i) {
      const int step = static_cast<int>(2.0F * options.half_m / kTexelM) / (kSamples + 1);
      crops.push_back(synthesis::paint_block(
          land, static_cast<float>(kTexelM), (i + 1) * step, (j + 1) * step, kCropPx, kCropPx));
    }
  }
  return crops;
}

std::vector<Image> photograph_crops(const std::filesystem::path& file) {
  WorldSpec spec;
  spec.imagery.push_back({file, "", {}});
  auto world = open_world(spec);
  std::vector<Image> crops;
  if (!world) return crops;
  const TileGrid& grid = world->tiles->grid();
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      auto tile = world->tiles->tile({0, col, row});
      if (!tile) continue;
      for (int quarter = 0; quarter < 4; ++quarter) {
        const int x0 = kTileBorder + (quarter % 2) * kCropPx;
        const int y0 = kTileBorder + (quarter / 2) * kCropPx;
        Image crop(kCropPx, kCropPx, 3);
        bool whole = true;
        for (int y = 0; y < kCropPx; ++y) {
          for (int x = 0; x < kCropPx; ++x) {
            whole = whole && tile->valid.at(x0 + x, y0 + y) != 0;
            for (int c = 0; c < 3; ++c) crop.at(x, y, c) = tile->rgb.at(x0 + x, y0 + y, c);
          }
        }
        if (whole) crops.push_back(std::move(crop));
      }
    }
  }
  return crops;
}

void expect_within_factor_two(double synthetic, double photograph, const char* what) {
  EXPECT_GT(synthetic / photograph, 0.5) << what << ": " << synthetic << " vs " << photograph;
  EXPECT_LT(synthetic / photograph, 2.0) << what << ": " << synthetic << " vs " << photograph;
}

TEST(LandscapeStatistics, MatchThePhotographWithinAFactorOfTwo) {
  OVERFLY_DATA_OR_SKIP(photo, "terrain/autzen/ortho_0.3m_utm10.tif");
  const std::vector<Image> real_crops = photograph_crops(photo);
  ASSERT_GT(real_crops.size(), 50U);
  const Statistics real = measure(real_crops);
  for (const std::uint32_t seed : {1U, 2U}) {
    const Statistics made = measure(synthetic_crops(seed));
    std::cout << "seed " << seed << ": spectrum slope " << made.slope << " (photo " << real.slope
              << "), FAST corners at 20: " << made.corners_20 << " (" << real.corners_20
              << "), at 7: " << made.corners_7 << " (" << real.corners_7
              << "), poorest twentieth: " << made.poorest_7 << " (" << real.poorest_7 << ")\n";
    expect_within_factor_two(made.slope, real.slope, "spectrum slope");
    expect_within_factor_two(made.corners_20, real.corners_20, "FAST corners at 20");
    expect_within_factor_two(made.corners_7, real.corners_7, "FAST corners at 7");
    EXPECT_LT(made.poorest_7, 0.5 * made.corners_7) << "a landscape has poor places too";
  }
}

}  // namespace
}  // namespace overfly::terrain
