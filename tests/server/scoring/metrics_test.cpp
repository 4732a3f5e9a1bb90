#include "server/scoring/metrics.hpp"

#include <gtest/gtest.h>

#include "core/time.hpp"

namespace overfly::server {
namespace {

/// The clock of the camera is wrong by 40 ms: outcomes have the times of the flight.
TEST(Metrics, OutcomesHaveTheTimesOfTheFlightNotOfTheStamps) {
  RunRecords records;
  EstimatorRecords estimator;
  for (int k = 0; k < 20; ++k) {
    FrameRow frame;
    frame.frame = k;
    frame.t_ns = k * kNsPerS / 10;
    frame.T_world_camera.translation.x() = 2.5 * k;
    records.cameras.front().frames.push_back(frame);
    EstimateRecord record;
    record.sample.frame = k;
    record.sample.t_ns = frame.t_ns - 40'000'000;
    record.sample.state = TrackingState::kTracking;
    record.sample.T_vo_camera = frame.T_world_camera;
    estimator.records.push_back(record);
  }
  estimator.records.back().crash = "it ended";
  records.estimators.push_back(estimator);
  const evaluation::Score score = metrics_from(records).estimators.begin()->second.score;
  EXPECT_EQ(score.outcome, evaluation::Outcome::kCrashed);
  EXPECT_DOUBLE_EQ(score.outcome_time_s.value(), 1.9);
  EXPECT_EQ(score.initialised_at_s, 0.0);
}

}  // namespace
}  // namespace overfly::server
