// The camera's self-test passes a right camera and measures a wrong one.
#include "server/camera/camera_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/support/server_fixture.hpp"
#include "tests/server/support/wrapped_renderer.hpp"

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;

/// Draws with the ray-caster, its pictures (not its depths) turned about the vertical image axis.
class TurnedRenderer final : public testing::WrappedRenderer {
 public:
  TurnedRenderer(std::unique_ptr<renderer::Renderer> inner, double turn_rad)
      : WrappedRenderer(std::move(inner)), turn_rad_(turn_rad) {}
  Result<renderer::CameraFrame> render_camera(const renderer::CameraRequest& request) override {
    // Every second picture: the same turn in both would not be seen between them.
    renderer::CameraRequest turned = request;
    if (++drawn_ % 2 == 0) {
      std::vector<StampedPose> poses = request.T_world_camera.poses();
      for (StampedPose& stamped : poses) {
        stamped.pose.rotation =
            stamped.pose.rotation * Eigen::AngleAxisd(turn_rad_, Eigen::Vector3d::UnitY());
      }
      turned.T_world_camera = CameraMotion::from_poses(poses).value();
    }
    return inner().render_camera(turned);
  }

 private:
  double turn_rad_;
  int drawn_ = 0;
};

RendererFactory turned_by(double turn_rad) {
  return [turn_rad](std::shared_ptr<const terrain::TileSource> tiles) {
    renderer::RendererOptions options;
    options.threads = 1;
    return Result<std::unique_ptr<renderer::Renderer>>(std::make_unique<TurnedRenderer>(
        renderer::create_raycast_renderer(std::move(tiles), options), turn_rad));
  };
}

class CameraCheck : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    scenario_ = new Result<Scenario>(camera_check_scenario(folder_->path()));
  }
  static void TearDownTestSuite() {
    delete scenario_;
    delete folder_;
  }
  static const Scenario& scenario() { return **scenario_; }

 private:
  static TemporaryFolder* folder_;
  static Result<Scenario>* scenario_;
};
TemporaryFolder* CameraCheck::folder_ = nullptr;
Result<Scenario>* CameraCheck::scenario_ = nullptr;

TEST_F(CameraCheck, PassesTheRayCasterThroughLensAndRollingShutter) {
  CameraCheckOptions options;
  options.pairs = 3;
  options.renderer_factory = turned_by(0.0);
  const auto rows = check_camera(scenario(), options);
  ASSERT_TRUE(rows.ok()) << rows.error().message;
  ASSERT_EQ(rows->size(), 2U);
  for (const CameraCheckRow& row : *rows) {
    EXPECT_EQ(row.fault, "") << row.camera;
    EXPECT_EQ(row.backend, "raycast");
    EXPECT_EQ(row.pairs.size(), 3U);
    EXPECT_GT(row.fewest_patches, 100);
    std::printf("[ CAMERA   ] %s: median %.4f px, p95 %.4f px, %d patches\n",
                row.camera.c_str(),
                row.worst_median_px,
                row.worst_p95_px,
                row.fewest_patches);
  }
}

TEST_F(CameraCheck, MeasuresAPoseThatIsNotTheOneDrawn) {
  const double fx_px = scenario().cameras.front().model.pinhole().fx_px;
  CameraCheckOptions options;
  options.pairs = 1;
  options.renderer_factory = turned_by(0.3 / fx_px);  // 0.3 px at the centre, more outside
  const auto rows = check_camera(scenario(), options);
  ASSERT_TRUE(rows.ok()) << rows.error().message;
  EXPECT_NEAR(rows->front().worst_median_px, 0.35, 0.08);
  EXPECT_NEAR(std::abs(rows->front().pairs.front().residual.mean_px.x()), 0.35, 0.08);
  EXPECT_THAT(rows->front().fault, HasSubstr("must be at most 0.1"));
}

TEST_F(CameraCheck, NamesBadOptionsAndFlightsTooShort) {
  CameraCheckOptions options;
  options.pairs = 0;
  EXPECT_THAT(check_camera(scenario(), options).error().message, HasSubstr("pairs = 0"));
  options.pairs = 1;
  options.limit_px = 0.0;
  EXPECT_THAT(check_camera(scenario(), options).error().message, HasSubstr("limit_px = 0"));
  options.limit_px = 0.1;
  options.renderer_factory = testing::noop_factory();
  const auto instant =
      check_camera(testing::small_scenario({"duration_s=0.01", "camera.rate_hz=1"}), options);
  ASSERT_FALSE(instant.ok());
  EXPECT_THAT(instant.error().message, HasSubstr("fewer than two frames"));
  const auto live =
      check_camera(testing::small_scenario(
                       {R"(flight={"mavlink":{"link":"tcp:127.0.0.1:1","patience_s":0.1}})"}),
                   options);
  EXPECT_THAT(live.error().message, HasSubstr("is that of a live vehicle"));
  // Patterns of the pose alone have no ground to find again: the test must not pass them.
  const auto blank = check_camera(testing::small_scenario(), options);
  ASSERT_TRUE(blank.ok()) << blank.error().message;
  EXPECT_NE(blank->front().fault, "");
}

}  // namespace
}  // namespace overfly::server
