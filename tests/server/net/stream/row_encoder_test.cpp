#include "server/net/stream/row_encoder.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <string>

#include "server/net/stream/series_list.hpp"
#include "server/record/rows/rows.hpp"
#include "server/record/run_info.hpp"

namespace overfly::net {
namespace {

Pose pose_of(double roll_deg, double pitch_deg, double yaw_deg) {
  return {
      R_world_body_from({rad_from_deg(roll_deg), rad_from_deg(pitch_deg), rad_from_deg(yaw_deg)}),
      {1.23456, -2.0, 300.0}};
}

TEST(RowEncoder, SaysPosesInMillimetresAndDegrees) {
  const auto json = pose_json(pose_of(10.0, -5.0, 123.4));
  EXPECT_EQ(json.at("x_m").dump(), "1.235");
  EXPECT_DOUBLE_EQ(json.at("roll_deg"), 10.0);
  EXPECT_DOUBLE_EQ(json.at("pitch_deg"), -5.0);
  EXPECT_DOUBLE_EQ(json.at("yaw_deg"), 123.4);
}

TEST(RowEncoder, GivesEveryColumnOneValueARow) {
  server::FrameRow row;
  row.frame = 3;
  row.t_ns = 96'774'194;
  row.T_world_body = pose_of(0, 0, 90);
  row.texels_per_pixel_median = 1.5;
  row.void_fraction = std::numeric_limits<double>::quiet_NaN();
  const auto columns = truth_columns({row, row});
  EXPECT_EQ(columns.size(), 11U);
  for (const auto& [name, values] : columns.items()) EXPECT_EQ(values.size(), 2U) << name;
  EXPECT_EQ(columns["t_ns"][1], 96'774'194);
  EXPECT_TRUE(columns["void_fraction"][0].is_null());
}

TEST(RowEncoder, SaysWhatTheSensorAndTheFaultsDidWhereTheyDid) {
  const server::FrameRow plain;
  server::FrameRow row;
  row.exposure_ns = 2'000'000;
  row.gain = 1.5;
  row.late_tiles = 3;
  row.late_frames = 2;
  row.stamp_offset_ns = -4000;
  row.faults = {"blackout", "stamp_offset"};
  const auto columns = truth_columns({plain, row});
  EXPECT_EQ(columns.at("exposure_ns").dump(), "[null,2000000]");
  EXPECT_EQ(columns.at("gain").dump(), "[null,1.5]");
  EXPECT_EQ(columns.at("saturated_fraction").dump(), "[null,0.0]");
  EXPECT_EQ(columns.at("late_tiles").dump(), "[null,3]");
  EXPECT_EQ(columns.at("late_frames").dump(), "[0,2]");
  EXPECT_EQ(columns.at("stamp_offset_ns").dump(), "[null,-4000]");
  EXPECT_EQ(columns.at("faults").dump(), R"([null,["blackout","stamp_offset"]])");
  EXPECT_FALSE(truth_columns({plain}).contains("faults"));
}

TEST(RowEncoder, CountsDroppedAndUnansweredFramesUntilEachAnswer) {
  const server::RunTimeline timeline({}, {"feature"});
  server::EstimateRow before;
  server::EstimateRow after;
  after.dropped_frames = 4;
  after.unanswered_frames = 1;
  const auto columns = estimate_columns(timeline, 0, {before, after});
  EXPECT_EQ(columns.at("dropped_frames").dump(), "[0,4]");
  EXPECT_EQ(columns.at("unanswered_frames").dump(), "[0,1]");
}

TEST(RowEncoder, LeavesPosesOutWhileNotTracking) {
  server::EstimateRow lost;
  lost.sample.state = TrackingState::kLost;
  server::EstimateRow tracked;
  tracked.sample.state = TrackingState::kTracking;
  tracked.T_world_body = pose_of(1, 2, 3);
  tracked.counters = {7.0};
  const server::RunTimeline timeline({}, {"a"});
  const auto columns = estimate_columns(timeline, 0, {lost, tracked});
  EXPECT_TRUE(columns["error_m"][1].is_null()) << "no frame is recorded";
  EXPECT_EQ(columns["state"][0], "LOST");
  EXPECT_TRUE(columns["yaw_deg"][0].is_null());
  EXPECT_DOUBLE_EQ(columns["yaw_deg"][1], 3.0);
}

TEST(RowEncoder, HasTheHonestyOfAnEstimatorThatStatesCovariances) {
  server::RunTimeline timeline({}, {"a"});
  timeline.set_cameras({{"", PinholeCamera(), Pose()}});
  server::FrameRow frame;
  timeline.append_frame(frame);
  server::EstimateRow row;
  row.sample.state = TrackingState::kTracking;
  row.T_world_body = Pose{Eigen::Quaterniond::Identity(), {3.0, 0.0, 0.0}};
  row.scale = 1.0;
  const auto nees_of_series = [&] {
    int count = 0;
    for (const auto& series : series_json(timeline)) count += series.at("group") == "nees" ? 1 : 0;
    return count;
  };
  timeline.append_estimate(0, row);
  EXPECT_FALSE(estimate_columns(timeline, 0, {row}).contains("nees_position"));
  EXPECT_EQ(nees_of_series(), 0);
  PoseCovariance covariance;
  covariance.matrix.diagonal().head<3>() << 2.25, 1.0, 1.0;
  row.sample.covariance = std::make_shared<const PoseCovariance>(covariance);
  timeline.append_estimate(0, row);
  server::EstimateRow without = row;
  without.sample.covariance.reset();
  const auto columns = estimate_columns(timeline, 0, {without, row});
  EXPECT_EQ(columns.at("nees_position").dump(), "[null,4.0]");
  EXPECT_NEAR(columns.at("nees_low")[1].get<double>(), 0.2158, 1e-4);
  EXPECT_NEAR(columns.at("nees_high")[1].get<double>(), 9.3484, 1e-4);
  EXPECT_EQ(nees_of_series(), 3);
}

TEST(SeriesList, TakesTheUnitOfACounterFromItsName) {
  server::RunTimeline timeline({}, {"a"});
  const std::map<std::string, double> counters = {
      {"map_memory_mb", 1.0}, {"residual_px", 1.0}, {"inliers", 1.0}, {"_m", 1.0}};
  timeline.append_estimate(0, {}, counters);
  std::map<std::string, std::string> units;
  for (const auto& series : series_json(timeline)) {
    const std::string column = series.at("column");
    if (column.starts_with("counter.")) units[series.at("label")] = series.at("unit");
  }
  const std::map<std::string, std::string> expected = {
      {"map memory", "MB"}, {"residual", "px"}, {"inliers", ""}, {" m", ""}};
  EXPECT_EQ(units, expected);
}

TEST(RowEncoder, SaysNullForARunWithoutError) {
  server::RunInfo info;
  EXPECT_TRUE(run_json(info).at("error").is_null());
  info.error = "bad";
  EXPECT_EQ(run_json(info).at("error"), "bad");
  EXPECT_TRUE(run_json(info).at("notice").is_null());
  info.notice = "making the built-in world: 30 %";
  EXPECT_EQ(run_json(info).at("notice"), info.notice);
  EXPECT_TRUE(run_json(info).at("world_change").is_null());
  info.flight = "course: 25 m/s";
  info.seed = 7;
  EXPECT_EQ(run_json(info).at("flight"), info.flight);
  EXPECT_EQ(run_json(info).at("seed"), 7);
  info.world_change = "ortho.tif has changed since this run was flown";
  EXPECT_EQ(run_json(info).at("world_change"), info.world_change);
}

}  // namespace
}  // namespace overfly::net
