#include "server/timeline/poses_at.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "server/record/run_info.hpp"

namespace overfly::server {
namespace {

Pose east(double x_m) { return {Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}}; }

/// 25 m/s at 30 Hz, whose stamps are rounded to 1 ns. `missing` is the only frame that the
/// estimator did not get.
std::shared_ptr<RunTimeline> flight_at_30_hz(int missing = -1) {
  auto timeline = std::make_shared<RunTimeline>(RunInfo{}, std::vector<std::string>{"a"});
  for (int k = 0; k < 30; ++k) {
    FrameRow frame;
    frame.frame = k;
    frame.t_ns = std::llround(k * 1e9 / 30.0);
    frame.T_world_body = east(25.0 * k / 30.0);
    timeline->append_frame(frame);
    if (k == missing) continue;
    EstimateRow row;
    row.sample.frame = k;
    row.sample.t_ns = frame.t_ns;
    row.sample.state = TrackingState::kTracking;
    row.T_world_body = frame.T_world_body;
    timeline->append_estimate(0, row);
  }
  return timeline;
}

double estimated_x_m(const RunTimeline& timeline, std::int64_t t_ns) {
  const auto alignment = RowAlignment::of(timeline, 0, kRecordedAlignment);
  EXPECT_TRUE(alignment.ok());
  const EstimateAt found = estimate_at(timeline, 0, *alignment, t_ns);
  return found.T_world_body ? found.T_world_body->translation.x() : std::nan("");
}

TEST(PosesAt, InterpolateTruthAndEstimateInEveryInterval) {
  const auto timeline = flight_at_30_hz();
  for (int k = 0; k < 29; ++k) {
    const std::int64_t t_ns = std::llround((k + 0.5) * 1e9 / 30.0);
    const FrameRow row = timeline->frame_at(t_ns).value();
    EXPECT_EQ(row.frame, k);
    const double x_m = 25.0 * (k + 0.5) / 30.0;
    EXPECT_NEAR(truth_at(*timeline, row, t_ns).translation.x(), x_m, 1e-6) << k;
    EXPECT_NEAR(estimated_x_m(*timeline, t_ns), x_m, 1e-6) << k;
  }
  // The last pose stays.
  EXPECT_NEAR(estimated_x_m(*timeline, 2'000'000'000), 25.0 * 29 / 30.0, 1e-9);
}

TEST(PosesAt, DoNotBridgeAFrameWithoutAnAnswer) {
  const auto timeline = flight_at_30_hz(10);
  EXPECT_NEAR(estimated_x_m(*timeline, std::llround(10.5 * 1e9 / 30.0)), 25.0 * 9 / 30.0, 1e-9);
}

}  // namespace
}  // namespace overfly::server
