// A drive through a street, as a camera on a car's roof sees it: forward motion among planes of
// every direction, with truth.
#pragma once

#include <cstdint>
#include <vector>

#include "core/camera/camera.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"
#include "tests/odometry/synthetic_flight.hpp"

namespace overfly::odometry::testing {

/// A road with houses on both sides that stand at different distances from it; sky above.
class Street {
 public:
  explicit Street(std::uint64_t seed);

  /// @param noise  standard deviation [grey levels]
  [[nodiscard]] Image render(const PinholeCamera& camera,
                             const Pose& T_world_camera,
                             double noise,
                             std::uint64_t noise_seed) const;

 private:
  /// A box on the ground; the road runs north, x is east.
  struct House {
    double west_m, east_m, south_m, north_m, height_m;
  };
  struct Hit {
    double along = 0.0;
    Eigen::Vector2d place_m = Eigen::Vector2d::Zero();  ///< on the texture
    double cosine = 1.0;                                ///< between ray and normal
  };
  [[nodiscard]] Hit cast(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) const;

  SyntheticGround texture_;
  std::vector<House> houses_;
};

struct DriveOptions {
  double speed_m_s = 10.0;
  double duration_s = 4.5;
  double rate_hz = 10.0;
  double yaw_rad_s = 0.06;  ///< at most: the car weaves
};

/// T_world_camera of each frame: forward, 1.65 m above the road, weaving and nodding a little.
[[nodiscard]] std::vector<Pose> drive(const DriveOptions& options);

/// 1242 x 375 px, 90 deg wide.
[[nodiscard]] PinholeCamera street_camera();

}  // namespace overfly::odometry::testing
