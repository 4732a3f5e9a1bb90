// How noisy samples are, judged only by the samples.
#pragma once

#include <span>

#include "flight/smoothing/samples.hpp"

namespace overfly::flight::smoothing {

/// Standard deviations of the samples' white noise. Errors that change slowly, as those of GPS do
/// over minutes, are not contained.
struct PositionNoise {
  double horizontal_m = 0.0;  ///< per axis
  double vertical_m = 0.0;
};

/// Method: third differences of four samples at even intervals remove a motion of constant
/// acceleration and have 20 times the noise's variance; their median size makes the result robust
/// against jumps. Even means that the longest interval is at most 1.5 times the shortest.
/// Zero if there are no four such samples.
[[nodiscard]] PositionNoise position_noise(std::span<const PositionSample> samples);
/// Per axis of the rotation vector [rad]; method as above.
[[nodiscard]] double attitude_noise_rad(std::span<const AttitudeSample> samples);

}  // namespace overfly::flight::smoothing
