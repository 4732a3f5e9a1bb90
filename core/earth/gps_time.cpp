#include "core/earth/gps_time.hpp"

#include <algorithm>
#include <array>

namespace overfly {
namespace {

constexpr std::int64_t kNsPerMilli = 1'000'000;
constexpr std::int64_t kMsPerWeek = 7LL * 86400 * 1000;
constexpr std::int64_t kGpsEpochUnixS = 315'964'800;  // 1980-01-06

/// The Unix times at which a leap second had just been inserted.
constexpr std::array<std::int64_t, 18> kLeapSecondsUnixS = {
    362'793'600,    // 1981-07-01
    394'329'600,    // 1982-07-01
    425'865'600,    // 1983-07-01
    489'024'000,    // 1985-07-01
    567'993'600,    // 1988-01-01
    631'152'000,    // 1990-01-01
    662'688'000,    // 1991-01-01
    709'948'800,    // 1992-07-01
    741'484'800,    // 1993-07-01
    773'020'800,    // 1994-07-01
    820'454'400,    // 1996-01-01
    867'715'200,    // 1997-07-01
    915'148'800,    // 1999-01-01
    1'136'073'600,  // 2006-01-01
    1'230'768'000,  // 2009-01-01
    1'341'100'800,  // 2012-07-01
    1'435'708'800,  // 2015-07-01
    1'483'228'800,  // 2017-01-01
};

}  // namespace

int leap_seconds_at(std::int64_t unix_ns) {
  int count = 0;
  for (const std::int64_t since_s : kLeapSecondsUnixS) {
    if (unix_ns >= since_s * 1'000'000'000) ++count;
  }
  return count;
}

GpsTime gps_time_from_unix_ns(std::int64_t unix_ns) {
  const std::int64_t gps_ms = std::max<std::int64_t>(
      0, unix_ns / kNsPerMilli - kGpsEpochUnixS * 1000 + 1000LL * leap_seconds_at(unix_ns));
  return {static_cast<std::uint16_t>(gps_ms / kMsPerWeek),
          static_cast<std::uint32_t>(gps_ms % kMsPerWeek)};
}

}  // namespace overfly
