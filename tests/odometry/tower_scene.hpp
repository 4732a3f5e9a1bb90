// Level ground with towers on a part of it: a scene where no plane holds, and one where it does.
#pragma once

#include <cstdint>

#include "core/camera/camera.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"
#include "tests/odometry/synthetic_flight.hpp"

namespace overfly::odometry::testing {

/// Towers of two heights stand up to a line across the way of fly_s_turns(); level ground is beyond
/// it.
class TowersBeforeAPlain {
 public:
  /// @param line_m  along the way from its beginning
  explicit TowersBeforeAPlain(double line_m);

  /// @param T_world_camera  above the towers, looking down
  [[nodiscard]] Image render(const PinholeCamera& camera,
                             const Pose& T_world_camera,
                             double noise,
                             std::uint64_t noise_seed) const;

 private:
  [[nodiscard]] double height_m(double east_m, double north_m) const;
  [[nodiscard]] Eigen::Vector3d hit(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) const;

  double line_m_;
  SyntheticGround texture_;
};

}  // namespace overfly::odometry::testing
