#include "server/timeline/window_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace overfly::server {
namespace {

/// A frame every metre along a circle of 500 m; the estimate's steps are too large by a factor
/// which grows by 1 % every 100 m.
class WindowErrorsTest : public ::testing::Test {
 protected:
  static constexpr double kRadius_m = 500.0;

  WindowErrorsTest() { timeline_.set_cameras({{"", PinholeCamera(), Pose()}}); }

  static Eigen::Vector3d truth_at(double way_m) {
    const double angle_rad = way_m / kRadius_m;
    return {kRadius_m * std::sin(angle_rad), kRadius_m * std::cos(angle_rad), 300.0};
  }

  void fly(int frames) {
    Eigen::Vector3d estimate = truth_at(0.0);
    for (int k = 0; k < frames; ++k) {
      FrameRow frame;
      frame.frame = k;
      frame.t_ns = k * 40'000'000LL;
      frame.T_world_body.translation = truth_at(k);
      frame.T_world_camera = frame.T_world_body;
      timeline_.append_frame(frame);
      if (k > 0) estimate += (1.0 + 1e-4 * k) * (truth_at(k) - truth_at(k - 1));
      EstimateRow row;
      row.sample.frame = k;
      row.sample.t_ns = frame.t_ns;
      row.sample.state = TrackingState::kTracking;
      row.T_world_body = Pose();
      row.T_world_body->translation = estimate;
      timeline_.append_estimate(0, row);
    }
  }

  [[nodiscard]] std::vector<EstimateRow> rows() const {
    return timeline_.estimates(0, 0, timeline_.estimate_count(0));
  }

  RunTimeline timeline_{RunInfo{}, {"a"}};
};

TEST_F(WindowErrorsTest, AreThoseOfTheLastHundredMetres) {
  fly(600);
  const auto errors = window_errors_of(timeline_, 0, rows(), RowAlignment());
  ASSERT_EQ(errors.size(), 600U);
  // The chord of 100 m takes 101 steps on this circle: its arc is 100.17 m long.
  EXPECT_FALSE(errors[100].scale) << "less than 100 m away from the first";
  ASSERT_TRUE(errors[101].scale);
  for (const std::size_t k : {101U, 300U, 599U}) {
    // The mean factor of the steps over the window, whose middle is 50 steps earlier.
    EXPECT_NEAR(errors[k].scale.value(), 1e-4 * (static_cast<double>(k) - 50.0), 2e-5) << k;
  }
}

TEST_F(WindowErrorsTest, AreTheSameInPartsAsInTheWhole) {
  fly(1500);
  const std::vector<EstimateRow> all = rows();
  const auto whole = window_errors_of(timeline_, 0, all, RowAlignment());
  std::vector<WindowErrors> parts;
  for (std::size_t begin = 0; begin < all.size(); begin += 7) {
    const auto part =
        window_errors_of(timeline_, 0, timeline_.estimates(0, begin, 7), RowAlignment());
    parts.insert(parts.end(), part.begin(), part.end());
  }
  ASSERT_EQ(parts.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_EQ(parts[k].scale, whole[k].scale) << k;
    ASSERT_EQ(parts[k].relative.has_value(), whole[k].relative.has_value()) << k;
    if (!whole[k].relative) continue;
    EXPECT_EQ(parts[k].relative->translation, whole[k].relative->translation) << k;
  }
}

TEST_F(WindowErrorsTest, AreEmptyAcrossMapsAndWhileLost) {
  fly(400);
  std::vector<EstimateRow> all = rows();
  for (std::size_t k = 200; k < 400; ++k) all[k].sample.map_id = 1;
  all[350].T_world_body.reset();
  const auto errors = window_errors_of(timeline_, 0, all, RowAlignment());
  EXPECT_TRUE(errors[199].scale);
  EXPECT_TRUE(errors[199].relative);
  EXPECT_FALSE(errors[200].scale);
  EXPECT_FALSE(errors[200].relative);
  EXPECT_FALSE(errors[300].scale);
  EXPECT_FALSE(errors[300].relative);
  EXPECT_TRUE(errors[301].scale);
  EXPECT_TRUE(errors[301].relative);
  EXPECT_FALSE(errors[350].scale);
  EXPECT_FALSE(errors[350].relative);
  EXPECT_TRUE(errors[351].scale);
  EXPECT_TRUE(errors[351].relative);
}

/// From frame 300 on the camera's clock is fast by 1 s, that is 25 m: so is the truth of the
/// stamps.
TEST_F(WindowErrorsTest, AreThoseAtTheStamps) {
  fly(600);
  std::vector<EstimateRow> all = rows();
  for (std::size_t k = 300; k < 600; ++k) all[k].sample.t_ns += 1'000'000'000;
  const auto errors = window_errors_of(timeline_, 0, all, RowAlignment());
  ASSERT_TRUE(errors[350].scale);
  EXPECT_NEAR(*errors[350].scale, -0.23, 0.03);
  ASSERT_TRUE(errors[500].scale);
  EXPECT_NEAR(*errors[500].scale, 0.045, 0.001);
  EXPECT_TRUE(errors[574].scale);
  EXPECT_FALSE(errors[575].scale) << "the truth does not reach it";
  EXPECT_FALSE(errors[575].relative);
}

TEST_F(WindowErrorsTest, OfAVehicleThatStandsAreEmpty) {
  for (int k = 0; k < 20; ++k) {
    FrameRow frame;
    frame.frame = k;
    timeline_.append_frame(frame);
    EstimateRow row;
    row.sample.frame = k;
    row.T_world_body = Pose();
    timeline_.append_estimate(0, row);
  }
  for (const auto& error : window_errors_of(timeline_, 0, rows(), RowAlignment())) {
    EXPECT_FALSE(error.scale);
    EXPECT_FALSE(error.relative);
  }
}

}  // namespace
}  // namespace overfly::server
