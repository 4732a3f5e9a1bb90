#include "terrain/decoration/cloud_field.hpp"

#include <cmath>
#include <vector>

#include "terrain/decoration/noise.hpp"

namespace overfly::terrain {
namespace {

constexpr int kOctaves = 6;
constexpr float kGain = 0.5F;
constexpr float kEdge = 0.04F;  // half width of a shadow's soft edge, in thickness

float shade(float thickness, float threshold) {
  return synthesis::smoothstep(threshold - kEdge, threshold + kEdge, thickness);
}

}  // namespace

CloudField::CloudField(const CloudOptions& options)
    : options_(options),
      seed_(static_cast<std::uint32_t>(options.seed ^ (options.seed >> 32U)) * 0x85EBCA6BU + 11U) {
  if (options.cover <= 0.0) return;
  // Samples at a distance of several clouds represent all the ground.
  constexpr int kSide = 160;
  std::vector<float> samples;
  samples.reserve(static_cast<std::size_t>(kSide) * kSide);
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      samples.push_back(thickness(0.731 * i * options.size_m, 0.731 * j * options.size_m));
    }
  }
  float low = -3.0F;
  float high = 3.0F;
  for (int step = 0; step < 40; ++step) {
    threshold_ = 0.5F * (low + high);
    double mean = 0.0;
    for (const float sample : samples) mean += shade(sample, threshold_);
    (mean / static_cast<double>(samples.size()) > options.cover ? low : high) = threshold_;
  }
}

float CloudField::thickness(double x_map_m, double y_map_m) const {
  return synthesis::fractal(static_cast<float>(x_map_m / options_.size_m),
                            static_cast<float>(y_map_m / options_.size_m),
                            kOctaves,
                            kGain,
                            seed_);
}

double CloudField::transmission(double x_map_m, double y_map_m) const {
  if (options_.cover <= 0.0) return 1.0;
  return 1.0 - options_.strength * shade(thickness(x_map_m, y_map_m), threshold_);
}

}  // namespace overfly::terrain
