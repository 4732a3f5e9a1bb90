#include "core/time.hpp"

#include <cmath>
#include <numeric>
#include <string>

namespace overfly {

// Products of a stamp, a nanosecond factor and a rate do not fit in 64 bits.
__extension__ using Int128 = __int128;

Result<FrameRate> FrameRate::from_hz(double rate_hz) {
  if (!(rate_hz > 0.0 && rate_hz <= 10000.0)) {
    return Error{ErrorCode::kInvalidArgument,
                 "rate_hz = " + std::to_string(rate_hz) + ": must be in (0, 10000]"};
  }
  constexpr std::int64_t kMicro = 1'000'000;
  const std::int64_t numerator = std::llround(rate_hz * static_cast<double>(kMicro));
  if (numerator == 0) {
    return Error{ErrorCode::kInvalidArgument,
                 "rate_hz = " + std::to_string(rate_hz) + ": must be at least 1e-6"};
  }
  const std::int64_t divisor = std::gcd(numerator, kMicro);
  return FrameRate{numerator / divisor, kMicro / divisor};
}

std::int64_t frame_time_ns(std::int64_t k, const FrameRate& rate) {
  const Int128 scaled = Int128{k} * kNsPerS * rate.denominator;
  return static_cast<std::int64_t>((scaled + rate.numerator / 2) / rate.numerator);
}

std::int64_t frame_count(std::int64_t duration_ns, const FrameRate& rate) {
  if (duration_ns < 0) return 0;
  const Int128 scaled = Int128{duration_ns} * rate.numerator;
  std::int64_t last = static_cast<std::int64_t>(scaled / (Int128{kNsPerS} * rate.denominator));
  // Rounding of the stamp can move the next frame inside.
  while (frame_time_ns(last + 1, rate) <= duration_ns) ++last;
  while (last >= 0 && frame_time_ns(last, rate) > duration_ns) --last;
  return last + 1;
}

std::int64_t ns_from_s(double t_s) { return std::llround(t_s * 1e9); }

}  // namespace overfly
