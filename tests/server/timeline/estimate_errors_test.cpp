#include "server/timeline/estimate_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace overfly::server {
namespace {

/// 10 m/s to the north-east (heading 45 deg) for ten frames, the camera at the body.
std::unique_ptr<RunTimeline> straight_flight(double speed_m_s = 10.0) {
  auto timeline = std::make_unique<RunTimeline>(RunInfo{}, std::vector<std::string>{"a"});
  timeline->set_cameras({{"", PinholeCamera(), Pose()}});
  for (int k = 0; k < 10; ++k) {
    FrameRow row;
    row.frame = 2 * k;  // every other frame was lost
    row.t_ns = k * 100'000'000LL;
    const double way_m = speed_m_s * 0.1 * k / std::sqrt(2.0);
    row.T_world_body.translation = {way_m, way_m, 50.0};
    row.T_world_camera = row.T_world_body;
    timeline->append_frame(row);
  }
  return timeline;
}

/// Of a frame of straight_flight(), with its time as stamp.
EstimateRow estimate_at(std::int64_t frame, const Pose& T_world_body) {
  EstimateRow row;
  row.sample.frame = frame;
  row.sample.t_ns = frame * 50'000'000;
  row.sample.state = TrackingState::kTracking;
  row.T_world_body = T_world_body;
  return row;
}

TEST(EstimateErrors, AreSplitByTheDirectionOfTheTrueMotion) {
  const auto flight = straight_flight();
  const RunTimeline& timeline = *flight;
  Pose off = timeline.frames(4, 1).front().T_world_body;
  // 3 m ahead, 2 m to the right (south-east), 1 m down, and 10 deg of yaw.
  const double d = 1.0 / std::sqrt(2.0);
  off.translation += Eigen::Vector3d(3.0 * d + 2.0 * d, 3.0 * d - 2.0 * d, -1.0);
  off.rotation = off.rotation *
                 Eigen::Quaterniond(Eigen::AngleAxisd(rad_from_deg(10), Eigen::Vector3d::UnitZ()));
  EstimateRow lost = estimate_at(10, Pose());
  lost.T_world_body.reset();
  const auto errors =
      errors_of(timeline, 0, {estimate_at(8, off), lost, estimate_at(20, off)}, RowAlignment());
  ASSERT_EQ(errors.size(), 3U);
  ASSERT_TRUE(errors[0]);
  EXPECT_NEAR(errors[0]->position.along_m, 3.0, 1e-12);
  EXPECT_NEAR(errors[0]->position.across_m, 2.0, 1e-12);
  EXPECT_NEAR(errors[0]->position.up_m, -1.0, 1e-12);
  EXPECT_NEAR(errors[0]->position_m(), std::sqrt(14.0), 1e-12);
  EXPECT_NEAR(deg_from_rad(errors[0]->rotation_rad), 10.0, 1e-9);
  EXPECT_FALSE(errors[1]) << "not tracking";
  EXPECT_FALSE(errors[2]) << "the truth ends before";
}

/// The score compares with the truth at the stamp, which a fault of the clock makes wrong.
TEST(EstimateErrors, AreThoseAtTheStamp) {
  const auto flight = straight_flight();
  EstimateRow slow = estimate_at(8, flight->frames(4, 1).front().T_world_body);
  slow.sample.t_ns -= 40'000'000;
  EstimateRow fast = slow;
  fast.sample.t_ns += 170'000'000;
  EstimateRow last = estimate_at(18, flight->frames(9, 1).front().T_world_body);
  last.sample.t_ns += 1;
  const auto errors = errors_of(*flight, 0, {slow, fast, last}, RowAlignment());
  ASSERT_TRUE(errors[0] && errors[1]);
  EXPECT_NEAR(errors[0]->position.along_m, 0.4, 1e-9);
  EXPECT_NEAR(errors[0]->position_m(), 0.4, 1e-9);
  EXPECT_NEAR(errors[1]->position.along_m, -1.3, 1e-9);
  EXPECT_FALSE(errors[2]) << "the truth does not reach it";
}

/// The estimator's frame is turned and in units of 50 m: its covariance is too.
TEST(EstimateErrors, AreComparedWithTheStatedCovariance) {
  const auto flight = straight_flight();
  Pose off = flight->frames(4, 1).front().T_world_body;
  off.translation += Eigen::Vector3d(4.0, 0.0, -1.0);
  EstimateRow row = estimate_at(8, off);
  row.scale = 50.0;
  const Eigen::Quaterniond R_world_vo(Eigen::AngleAxisd(0.5 * kPi, Eigen::Vector3d::UnitZ()));
  row.sample.T_vo_camera.rotation = R_world_vo.conjugate() * off.rotation;
  PoseCovariance covariance;
  covariance.has_rotation = false;
  // In the world: 3 m along y (north), 2 m along x, 0.5 m along z.
  covariance.matrix.diagonal().head<3>() << 9.0 / 2500.0, 4.0 / 2500.0, 0.25 / 2500.0;
  row.sample.covariance = std::make_shared<const PoseCovariance>(covariance);
  const auto errors = errors_of(*flight, 0, {row, estimate_at(8, off)}, RowAlignment());
  ASSERT_TRUE(errors[0] && errors[0]->position_nees);
  EXPECT_NEAR(*errors[0]->position_nees, 4.0 + 4.0, 1e-9);
  ASSERT_TRUE(errors[1]);
  EXPECT_FALSE(errors[1]->position_nees);
}

/// Slower than 1 m/s the nose (to the east here) gives the direction.
TEST(EstimateErrors, AreInTheAxesOfTheNoseWithoutMotion) {
  const auto flight = straight_flight(0.5);
  const RunTimeline& timeline = *flight;
  Pose off = timeline.frames(4, 1).front().T_world_body;
  off.translation += Eigen::Vector3d(3.0, -2.0, -1.0);
  const auto errors = errors_of(timeline, 0, {estimate_at(8, off)}, RowAlignment());
  ASSERT_TRUE(errors[0]);
  EXPECT_NEAR(errors[0]->position.along_m, 3.0, 1e-12);
  EXPECT_NEAR(errors[0]->position.across_m, 2.0, 1e-12);
  EXPECT_NEAR(errors[0]->position.up_m, -1.0, 1e-12);
}

/// A row that is sent alone, during the flight, has the errors that it has among all rows after it.
TEST(EstimateErrors, DoNotDependOnWhatComesLater) {
  RunTimeline timeline(RunInfo{}, {"a"});
  timeline.set_cameras({{"", PinholeCamera(), Pose()}});
  std::vector<EstimateRow> rows;
  std::vector<EstimateError> alone;
  for (int k = 0; k < 40; ++k) {
    FrameRow frame;
    frame.frame = k;
    frame.t_ns = k * 30'000'000LL;
    frame.T_world_body.translation = {0.5 * k, 0.02 * k * k, 50.0};
    frame.T_world_camera = frame.T_world_body;
    timeline.append_frame(frame);
    Pose off = frame.T_world_body;
    off.translation += Eigen::Vector3d(0.1 * k, 2.0, 1.0);
    rows.push_back(estimate_at(k, off));
    rows.back().sample.t_ns = frame.t_ns;
    const auto errors = errors_of(timeline, 0, {rows.back()}, RowAlignment());
    ASSERT_TRUE(errors.front());
    alone.push_back(*errors.front());
  }
  const auto together = errors_of(timeline, 0, rows, RowAlignment());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_TRUE(together[i]) << i;
    EXPECT_EQ(together[i]->position.along_m, alone[i].position.along_m) << i;
    EXPECT_EQ(together[i]->position.across_m, alone[i].position.across_m) << i;
    EXPECT_EQ(together[i]->rotation_rad, alone[i].rotation_rad) << i;
  }
}

TEST(EstimateErrors, AreThoseOfTheCameraNotOfTheBody) {
  RunTimeline timeline(RunInfo{}, {"a"});
  const Pose mount{Eigen::Quaterniond::Identity(), Eigen::Vector3d(5.0, 0.0, 0.0)};
  timeline.set_cameras({{"", PinholeCamera(), mount}});
  FrameRow row;
  row.T_world_camera = mount;
  timeline.append_frame(row);
  // The body turns by 180 deg about the vertical: the camera moves by 10 m, the body does not.
  Pose turned;
  turned.rotation = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitZ());
  const auto errors = errors_of(timeline, 0, {estimate_at(0, turned)}, RowAlignment());
  ASSERT_TRUE(errors[0]);
  EXPECT_NEAR(errors[0]->position_m(), 10.0, 1e-9);
}

TEST(RunTimeline, KeepsCountersByTheOrderOfTheirFirstUse) {
  RunTimeline timeline(RunInfo{}, {"a"});
  timeline.append_estimate(0, EstimateRow(), {{"inliers", 30.0}});
  timeline.append_estimate(0, EstimateRow(), {{"blocks", 2.0}, {"inliers", 31.0}});
  timeline.append_estimate(0, EstimateRow());
  EXPECT_EQ(timeline.counter_names(0), (std::vector<std::string>{"inliers", "blocks"}));
  const auto rows = timeline.estimates(0, 0, 3);
  EXPECT_EQ(rows[0].counters, std::vector<double>{30.0});
  EXPECT_EQ(rows[1].counters, (std::vector<double>{31.0, 2.0}));
  EXPECT_TRUE(rows[2].counters.empty());
  std::map<std::string, double> many;
  for (int i = 0; i < 100; ++i) many["c" + std::to_string(i)] = i;
  timeline.append_estimate(0, EstimateRow(), many);
  EXPECT_EQ(timeline.counter_names(0).size(), RunTimeline::kMaxCounters);
}

}  // namespace
}  // namespace overfly::server
