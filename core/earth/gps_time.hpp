// GPS time from UTC.
#pragma once

#include <cstdint>

namespace overfly {

/// Weeks since 1980-01-06 00:00:00 UTC, counted on without a rollover, and the time in the week.
struct GpsTime {
  std::uint16_t week = 0;
  std::uint32_t week_ms = 0;
};

/// GPS time minus UTC [s]: the leap seconds since 1980 (IERS Bulletin C; the last one was at the
/// end of 2016).
/// @param unix_ns  UTC since 1970-01-01 without leap seconds [ns]
[[nodiscard]] int leap_seconds_at(std::int64_t unix_ns);

/// Earlier times than 1980-01-06 give its first instant.
[[nodiscard]] GpsTime gps_time_from_unix_ns(std::int64_t unix_ns);

}  // namespace overfly
