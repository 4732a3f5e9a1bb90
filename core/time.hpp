// Time stamps of camera frames, computed from the frame index so that errors do not accumulate.
#pragma once

#include <cstdint>

#include "core/result.hpp"

namespace overfly {

inline constexpr std::int64_t kNsPerS = 1'000'000'000;

/// A frame rate as a fraction [Hz]: 31 Hz = {31, 1}, 29.97 Hz = {30000, 1001}.
struct FrameRate {
  std::int64_t numerator = 31;
  std::int64_t denominator = 1;

  /// Converts a decimal rate to the nearest fraction, exact to 1e-6 Hz.
  /// Errors: kInvalidArgument outside (0, 10000].
  static Result<FrameRate> from_hz(double rate_hz);
  [[nodiscard]] double hz() const {
    return static_cast<double>(numerator) / static_cast<double>(denominator);
  }
};

/// Stamp of frame k >= 0: k / rate rounded to the nearest nanosecond [ns].
/// The error is at most 0.5 ns for every k (31 Hz has no integer period).
[[nodiscard]] std::int64_t frame_time_ns(std::int64_t k, const FrameRate& rate);

/// Number of frames with stamps in [0, duration_ns].
[[nodiscard]] std::int64_t frame_count(std::int64_t duration_ns, const FrameRate& rate);

[[nodiscard]] constexpr double s_from_ns(std::int64_t t_ns) {
  return static_cast<double>(t_ns) * 1e-9;
}
/// Converts seconds to the nearest nanosecond.
[[nodiscard]] std::int64_t ns_from_s(double t_s);

}  // namespace overfly
