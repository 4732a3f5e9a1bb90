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

}  // namespace
}  // namespace overfly::server
