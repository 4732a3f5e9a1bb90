#include "server/record/rows/run_rows.hpp"

#include <gtest/gtest.h>

namespace overfly::server {
namespace {

TEST(RunRows, ReadBackExactly) {
  FrameRow record;
  record.frame = 7;
  record.t_ns = 225806452;
  record.T_world_camera.translation = {1.0 / 3.0, -2e-17, 1e8 / 7.0};
  record.T_world_camera.rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  record.axis_depth_m = 1e3 / 9.0;
  const auto read = frame_row_from(nlohmann::json::parse(json_from(record).dump()), Pose{});
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->T_world_camera.matrix(), record.T_world_camera.matrix());
  EXPECT_EQ(read->axis_depth_m, record.axis_depth_m);
  EXPECT_EQ(read->t_ns, record.t_ns);
  EXPECT_EQ(frame_row_from({{"frame", 1}}, Pose{}).error().code, ErrorCode::kUnreadable);
}

EstimateRecord tracked_record() {
  EstimateRecord record;
  record.sample.frame = 3;
  record.sample.state = TrackingState::kTracking;
  PoseCovariance covariance;
  covariance.matrix.diagonal() << 1.0 / 3.0, 0.5, 1e-9 / 7.0, 1e-5, 2e-5, 3e-5;
  covariance.matrix(0, 4) = covariance.matrix(4, 0) = 1e-4 / 7.0;
  record.sample.covariance = std::make_shared<const PoseCovariance>(covariance);
  return record;
}

TEST(RunRows, CovarianceIsReadBackExactly) {
  const EstimateRecord record = tracked_record();
  const auto read = estimate_record_from(nlohmann::json::parse(json_from(record).dump()));
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_NE(read->sample.covariance, nullptr);
  EXPECT_EQ(read->sample.covariance->matrix, record.sample.covariance->matrix);
  EXPECT_FALSE(read->sample.covariance_left_out);

  EstimateRecord left_out = record;
  left_out.sample.covariance.reset();
  left_out.sample.covariance_left_out = true;
  const auto marked = estimate_record_from(json_from(left_out));
  ASSERT_TRUE(marked.ok()) << marked.error().message;
  EXPECT_EQ(marked->sample.covariance, nullptr);
  EXPECT_TRUE(marked->sample.covariance_left_out);
}

TEST(RunRows, CovarianceOfAnUntidyRowIsLeftOutAndThePoseStays) {
  for (const char* const untidy :
       {"[1, 2, 3]", "[1, 0, 0, -1, 0, 1]", "[1, null, 0, 1, 0, 1]", R"(["a", 0, 0, 1, 0, 1])"}) {
    nlohmann::json line = json_from(tracked_record());
    line["covariance"] = nlohmann::json::parse(untidy);
    const auto read = estimate_record_from(line);
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->sample.state, TrackingState::kTracking);
    EXPECT_EQ(read->sample.covariance, nullptr) << untidy;
    EXPECT_TRUE(read->sample.covariance_left_out) << untidy;
  }
  nlohmann::json line = json_from(tracked_record());
  line["covariance"] = 3;
  EXPECT_EQ(estimate_record_from(line).error().code, ErrorCode::kUnreadable);
  line.erase("covariance");
  const auto older = estimate_record_from(line);
  ASSERT_TRUE(older.ok()) << older.error().message;
  EXPECT_EQ(older->sample.covariance, nullptr);
  EXPECT_FALSE(older->sample.covariance_left_out);
}

}  // namespace
}  // namespace overfly::server
