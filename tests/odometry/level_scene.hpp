// A short level flight in small images, for tests of single parts of the estimator.
#pragma once

#include "odometry/image/frame_image.hpp"
#include "tests/odometry/synthetic_flight.hpp"

namespace overfly::odometry::testing {

/// 40 m/s, 200 m above ground of gentle relief, 320 x 240 px.
class LevelScene {
 public:
  explicit LevelScene(double duration_s = 1.6);

  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  [[nodiscard]] const SyntheticGround& ground() const { return ground_; }
  [[nodiscard]] const std::vector<Pose>& T_world_camera() const { return T_world_camera_; }
  [[nodiscard]] FrameImage frame(std::size_t i) const { return frame(i, T_world_camera_.at(i)); }
  /// As frame `i`, from elsewhere.
  [[nodiscard]] FrameImage frame(std::size_t i, const Pose& T_world_camera) const;

 private:
  PinholeCamera camera_;
  SyntheticGround ground_;
  std::vector<Pose> T_world_camera_;
};

}  // namespace overfly::odometry::testing
