// Errors of GPS fixes against the truth between frames.
#include "server/timeline/gps_errors.hpp"

#include <gtest/gtest.h>

#include "core/time.hpp"

namespace overfly::server {
namespace {

FrameRow frame_at(std::int64_t frame, std::int64_t t_ns, const Eigen::Vector3d& place_world_m) {
  FrameRow row;
  row.frame = frame;
  row.t_ns = t_ns;
  row.T_world_body.translation = place_world_m;
  return row;
}

TEST(GpsErrors, AreMeasuredMinusTruePlaceAtTheTimeOfMeasurement) {
  const Geodetic origin = geodetic_from_deg(47.0, 8.0, 500.0);
  const LocalFrame world(origin);
  RunTimeline timeline(RunInfo{}, {});
  // 20 m/s to the east, a frame every 0.1 s, and none between 1 s and 2 s.
  for (std::int64_t i = 0; i <= 30; ++i) {
    const std::int64_t t_ns = i * kNsPerS / 10;
    if (t_ns > kNsPerS && t_ns < 2 * kNsPerS) continue;
    timeline.append_frame(frame_at(i, t_ns, {20.0 * s_from_ns(t_ns), 0.0, 100.0}));
  }
  const GpsErrors errors(timeline, origin);
  GpsSample fix;
  fix.t_ns = 440'000'000;
  fix.delivered_ns = 900'000'000;
  fix.place = world.geodetic_from_world({20.0 * 0.44 + 1.5, -2.0, 103.0});
  const auto error = errors.of(fix);
  ASSERT_TRUE(error.has_value());
  EXPECT_LT((*error - Eigen::Vector3d(1.5, -2.0, 3.0)).norm(), 1e-6);
  fix.t_ns = kNsPerS;
  fix.place = world.geodetic_from_world({20.0, 0.0, 100.0});
  EXPECT_LT(errors.of(fix)->norm(), 1e-6);
  for (const std::int64_t t_ns : {1'500'000'000LL, 3'000'000'001LL, -1LL}) {
    fix.t_ns = t_ns;
    EXPECT_FALSE(errors.of(fix).has_value()) << t_ns;
  }
  fix.t_ns = kNsPerS;
  fix.fix = GpsFixType::kNone;
  EXPECT_FALSE(errors.of(fix).has_value());
}

}  // namespace
}  // namespace overfly::server
