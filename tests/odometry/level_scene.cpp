#include "tests/odometry/level_scene.hpp"

#include "core/time.hpp"

namespace overfly::odometry::testing {
namespace {

std::vector<Pose> level_flight(double duration_s) {
  SyntheticFlightOptions options;
  options.speed_m_s = 40.0;
  options.height_m = 200.0;
  options.straight_s = 60.0;
  options.duration_s = duration_s;
  return fly_s_turns(options);
}

}  // namespace

LevelScene::LevelScene(double duration_s)
    : camera_(
          PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal).value()),
      ground_(SyntheticGround::procedural(1, 512, 1.0, 5.0)),
      T_world_camera_(level_flight(duration_s)) {}

FrameImage LevelScene::frame(std::size_t i, const Pose& T_world_camera) const {
  const auto index = static_cast<std::int64_t>(i);
  return {index,
          frame_time_ns(index, FrameRate{}),
          build_pyramid(
              std::make_shared<const Image>(ground_.render(camera_, T_world_camera, 1.0, i + 1)))};
}

}  // namespace overfly::odometry::testing
