// The sensor's random numbers, judged by their statistics. Bounds are five standard deviations of
// the estimate for the sample's size; seeds are fixed, so a test that passes passes always.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sensor/noise_source.hpp"
#include "tests/sensor/flat_field.hpp"
#include "tests/support/support.hpp"

namespace overfly::sensor {
namespace {

using overfly::testing::larger_error;
using testing::correlation;
using testing::counting_sensor;
using testing::flat_field;
using testing::Moments;
using testing::moments_of;
using testing::sensor_of;
using testing::small_camera;
using testing::values_of;

constexpr int kNoisyWidth = 640;
constexpr int kNoisyHeight = 480;

SensorModel read_noise_sensor() {
  SensorModel model = counting_sensor();
  model.read_noise_e = 1000.0;
  return model;
}

std::vector<double> noise_image(std::uint64_t seed, std::int64_t frame) {
  const auto sensor = sensor_of(read_noise_sensor(), small_camera(kNoisyWidth, kNoisyHeight), seed);
  return values_of(sensor->expose(flat_field(kNoisyWidth, kNoisyHeight, 0.5F), frame).image16);
}

/// The image moved by (dx, dy), both parts of equal length.
double correlation_at(const std::vector<double>& image, int dx, int dy) {
  std::vector<double> here;
  std::vector<double> there;
  for (int y = 0; y + dy < kNoisyHeight; ++y) {
    for (int x = 0; x + dx < kNoisyWidth; ++x) {
      here.push_back(image[static_cast<std::size_t>(y) * kNoisyWidth + x]);
      there.push_back(image[static_cast<std::size_t>(y + dy) * kNoisyWidth + x + dx]);
    }
  }
  return correlation(here, there);
}

void expect_standard_normal(const std::vector<double>& values) {
  const Moments m = moments_of(values);
  const auto n = static_cast<double>(values.size());
  EXPECT_NEAR(m.mean, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(m.variance, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(m.skewness, 0.0, 5.0 * std::sqrt(6.0 / n));
  EXPECT_NEAR(m.excess_kurtosis, 0.0, 5.0 * std::sqrt(24.0 / n));
}

/// Largest distance between the sample's and the normal distribution function.
double distance_from_normal(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double largest = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double expected = 0.5 * std::erfc(-values[i] / std::sqrt(2.0));
    const double below = static_cast<double>(i) / static_cast<double>(values.size());
    largest = larger_error(largest, std::abs(below - expected));
  }
  return largest;
}

TEST(Noise, NormalPairsAreStandardNormalAndIndependent) {
  const NoiseKey key = noise_key(7, 3, NoiseStage::kTemporal);
  std::vector<double> first;
  std::vector<double> second;
  std::vector<double> product_of_squares;
  ChunkWords words;
  for (std::uint32_t chunk = 0; chunk < 4096; ++chunk) {
    draw_words(key, chunk * kQuads, words);
    for (const std::uint32_t word : words.of) {
      const NormalPair pair = normal_pair(word);
      first.push_back(pair.first);
      second.push_back(pair.second);
    }
  }
  expect_standard_normal(first);
  expect_standard_normal(second);
  const auto n = static_cast<double>(first.size());
  EXPECT_NEAR(correlation(first, second), 0.0, 5.0 / std::sqrt(n));
  // Kolmogorov and Smirnov: 1.95 / sqrt(n) is exceeded once in a thousand.
  EXPECT_LT(distance_from_normal(first), 1.95 / std::sqrt(n));
  EXPECT_LT(distance_from_normal(second), 1.95 / std::sqrt(n));
  for (double& value : first) value *= value;
  for (double& value : second) value *= value;
  EXPECT_NEAR(correlation(first, second), 0.0, 5.0 / std::sqrt(n)) << "squares";
}

TEST(Noise, TailsReachPastFourStandardDeviations) {
  const NoiseKey key = noise_key(9, 0, NoiseStage::kTemporal);
  ChunkWords words;
  int beyond_4 = 0;
  constexpr int kChunks = 16384;
  for (std::uint32_t chunk = 0; chunk < kChunks; ++chunk) {
    draw_words(key, chunk * kQuads, words);
    for (const std::uint32_t word : words.of) beyond_4 += std::abs(normal_pair(word).first) > 4.0F;
  }
  const double expected = kChunks * kChunk * std::erfc(4.0 / std::sqrt(2.0));
  EXPECT_NEAR(beyond_4, expected, 5.0 * std::sqrt(expected));
}

TEST(Noise, BitsOfTheWordsAreBalancedAndIndependent) {
  const NoiseKey key = noise_key(1, 2, NoiseStage::kTemporal);
  std::array<std::array<int, 32>, 32> both{};
  ChunkWords words;
  constexpr int kChunks = 1024;
  for (std::uint32_t chunk = 0; chunk < kChunks; ++chunk) {
    draw_words(key, chunk * kQuads, words);
    for (const std::uint32_t word : words.of) {
      for (unsigned a = 0; a < 32; ++a) {
        if ((word >> a & 1U) == 0) continue;
        for (unsigned b = 0; b < 32; ++b) both[a][b] += static_cast<int>(word >> b & 1U);
      }
    }
  }
  constexpr double kWords = kChunks * kChunk;
  for (unsigned a = 0; a < 32; ++a) {
    for (unsigned b = 0; b < 32; ++b) {
      const double p = a == b ? 0.5 : 0.25;
      // Of 1024 cells the worst lies near 3.3 standard deviations.
      EXPECT_NEAR(both[a][b], kWords * p, 5.0 * std::sqrt(kWords * p * (1.0 - p))) << a << ' ' << b;
    }
  }
}

TEST(Noise, NeighboursRowsFramesAndSeedsAreUncorrelated) {
  const std::vector<double> image = noise_image(1, 0);
  const double bound = 5.0 / std::sqrt(static_cast<double>(image.size()) * 0.8);
  for (int dx = 1; dx <= 4; ++dx) EXPECT_NEAR(correlation_at(image, dx, 0), 0.0, bound) << dx;
  for (int dy = 1; dy <= 4; ++dy) EXPECT_NEAR(correlation_at(image, 0, dy), 0.0, bound) << dy;
  // Samples that one hash serves.
  EXPECT_NEAR(correlation_at(image, kQuads, 0), 0.0, bound);
  EXPECT_NEAR(correlation_at(image, 2 * kQuads, 0), 0.0, bound);
  EXPECT_NEAR(correlation_at(image, kChunk, 0), 0.0, bound);
  for (const std::int64_t frame : {1, 2, 1000000}) {
    EXPECT_NEAR(correlation(image, noise_image(1, frame)), 0.0, bound) << frame;
  }
  for (const std::uint64_t seed : {2U, 3U, 0U}) {
    EXPECT_NEAR(correlation(image, noise_image(seed, 0)), 0.0, bound) << seed;
  }
}

/// One of the four lanes that a hash serves, first of each pair.
std::vector<float> lane_of_normals(std::uint64_t seed, std::int64_t frame, int lane, int chunks) {
  const NoiseKey key = noise_key(seed, frame, NoiseStage::kTemporal);
  std::vector<float> normals;
  ChunkWords words;
  for (int chunk = 0; chunk < chunks; ++chunk) {
    draw_words(key, static_cast<std::uint32_t>(chunk * kQuads), words);
    for (int i = 0; i < kQuads; ++i) {
      normals.push_back(normal_pair(words.of[lane * kQuads + i]).first);
    }
  }
  return normals;
}

TEST(Noise, ManyFramesAreUncorrelatedInEveryLaneOfTheHash) {
  constexpr int kFrames = 20;
  constexpr int kChunks = 160;
  for (int lane = 0; lane < 4; ++lane) {
    std::vector<std::vector<float>> frames;
    frames.reserve(kFrames);
    for (int i = 0; i < kFrames; ++i) frames.push_back(lane_of_normals(1, i, lane, kChunks));
    double sum_of_squares = 0.0;
    int pairs = 0;
    for (int a = 0; a < kFrames; ++a) {
      for (int b = 0; b < a; ++b, ++pairs) {
        double product = 0.0;
        for (std::size_t i = 0; i < frames[a].size(); ++i) product += frames[a][i] * frames[b][i];
        // Of independent normals: normal with a variance of their number.
        const double deviations = product / std::sqrt(static_cast<double>(frames[a].size()));
        EXPECT_LT(std::abs(deviations), 5.0) << "lane " << lane << ", frames " << a << ' ' << b;
        sum_of_squares += deviations * deviations;
      }
    }
    EXPECT_NEAR(sum_of_squares / pairs, 1.0, 5.0 * std::sqrt(2.0 / pairs)) << "lane " << lane;
  }
}

TEST(Noise, ReadNoiseHasItsStandardDeviation) {
  std::vector<double> values = noise_image(5, 11);
  for (double& value : values) value = (value - 0.5 * 65535.0) / 1000.0;
  expect_standard_normal(values);
}

/// Counts of photo-electrons under even light of a mean, read as numbers.
std::vector<int> histogram_of_counts(double mean_e) {
  SensorModel model = counting_sensor();
  model.shot_noise = true;
  const auto sensor = sensor_of(model, small_camera(kNoisyWidth, kNoisyHeight), 3);
  std::vector<int> histogram(400, 0);
  for (std::int64_t frame = 0; frame < 4; ++frame) {
    const auto light = flat_field(kNoisyWidth, kNoisyHeight, static_cast<float>(mean_e / 65535.0));
    for (const std::uint16_t count : sensor->expose(light, frame).image16.data) {
      ++histogram[std::min<std::size_t>(count, histogram.size() - 1)];
    }
  }
  return histogram;
}

double poisson_probability(double mean, int k) {
  return std::exp(-mean + k * std::log(mean) - std::lgamma(k + 1.0));
}

/// Chi-squared of the histogram against Poisson's distribution, in standard deviations from its
/// expectation; counts expected less than 20 times are put together.
double chi_squared_deviation(const std::vector<int>& histogram, double mean) {
  double all = 0.0;
  for (const int count : histogram) all += count;
  double chi_squared = 0.0;
  double rest_expected = all;
  double rest_seen = all;
  int cells = 0;
  for (std::size_t k = 0; k < histogram.size(); ++k) {
    const double expected = all * poisson_probability(mean, static_cast<int>(k));
    if (expected < 20.0) continue;
    chi_squared += (histogram[k] - expected) * (histogram[k] - expected) / expected;
    rest_expected -= expected;
    rest_seen -= histogram[k];
    ++cells;
  }
  if (rest_expected > 5.0) {
    chi_squared += (rest_seen - rest_expected) * (rest_seen - rest_expected) / rest_expected;
    ++cells;
  }
  const double freedom = cells - 1.0;
  return (chi_squared - freedom) / std::sqrt(2.0 * freedom);
}

TEST(ShotNoise, FewElectronsFollowPoissonsDistribution) {
  // float(mean / 65535) * 65535 is off by 1e-7: far below the resolution of 1.2 million counts.
  for (const double mean : {0.01, 0.3, 1.0, 4.0, 11.5, 23.9}) {
    EXPECT_LT(chi_squared_deviation(histogram_of_counts(mean), mean), 4.0) << mean;
  }
}

TEST(ShotNoise, ManyElectronsComeNearPoissonsDistribution) {
  // A distribution at total variation distance d adds about n (2 d)^2 / 2 to chi-squared of n
  // counts at most: 1.2e6 * 2 * (9e-4)^2 = 2 at the worst place, a mean of 24.
  for (const double mean : {24.1, 40.0, 120.0}) {
    EXPECT_LT(chi_squared_deviation(histogram_of_counts(mean), mean), 5.0) << mean;
  }
}

TEST(ShotNoise, KeepsMeanVarianceAndSkewnessOfPoissonAtEveryMean) {
  SensorModel model = counting_sensor();
  model.shot_noise = true;
  const auto sensor = sensor_of(model, small_camera(kNoisyWidth, kNoisyHeight), 5);
  for (const double mean : {0.5, 5.0, 20.0, 25.0, 100.0, 3000.0, 40000.0}) {
    const auto light = flat_field(kNoisyWidth, kNoisyHeight, static_cast<float>(mean / 65535.0));
    const Moments m = moments_of(values_of(sensor->expose(light, 0).image16));
    const auto n = static_cast<double>(m.count);
    EXPECT_NEAR(m.mean, mean, 5.0 * std::sqrt(mean / n)) << mean;
    const double spread = std::sqrt((2.0 + 1.0 / mean) / n);
    EXPECT_NEAR(m.variance / mean, 1.0, 5.0 * spread) << mean;
    EXPECT_NEAR(m.skewness, 1.0 / std::sqrt(mean), 5.0 * std::sqrt((6.0 + 20.0 / mean) / n))
        << mean;
  }
}

TEST(ShotNoise, NoLightLeavesNoElectron) {
  SensorModel model = counting_sensor();
  model.shot_noise = true;
  const auto sensor = sensor_of(model, small_camera(64, 48), 5);
  for (const float radiance : {0.0F, -1.0F}) {
    const SensorImage dark = sensor->expose(flat_field(64, 48, radiance), 0);
    EXPECT_EQ(dark.mean_level, 0.0);
  }
}

}  // namespace
}  // namespace overfly::sensor
