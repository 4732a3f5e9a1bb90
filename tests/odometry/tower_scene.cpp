#include "tests/odometry/tower_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/odometry/grey_noise.hpp"

namespace overfly::odometry::testing {
namespace {

constexpr std::array<double, 3> kHeightsM{0.0, 100.0, 150.0};
constexpr double kSideM = 20.0;
constexpr double kStepM = 5.0;   ///< in height
constexpr double kYawRad = 0.3;  ///< of fly_s_turns()

}  // namespace

TowersBeforeAPlain::TowersBeforeAPlain(double line_m)
    : line_m_(line_m), texture_(SyntheticGround::procedural(1, 512, 1.0, 0.0)) {}

double TowersBeforeAPlain::height_m(double east_m, double north_m) const {
  static const double kEast = std::sin(kYawRad);
  static const double kNorth = std::cos(kYawRad);
  if (east_m * kEast + north_m * kNorth > line_m_) return 0.0;
  const auto column = static_cast<int>(std::floor(east_m / kSideM));
  const auto row = static_cast<int>(std::floor(north_m / kSideM));
  // About as much of each height is seen from 200 m.
  const unsigned cell =
      (73'856'093U * static_cast<unsigned>(column)) ^ (19'349'663U * static_cast<unsigned>(row));
  const unsigned lot = (cell >> 8U) % 16U;
  return lot == 0 ? kHeightsM[2] : lot < 4 ? kHeightsM[1] : kHeightsM[0];
}

/// The first place on a ray from above that is not in the air, to a step in height.
Eigen::Vector3d TowersBeforeAPlain::hit(const Eigen::Vector3d& eye,
                                        const Eigen::Vector3d& ray) const {
  Eigen::Vector3d place;
  for (double z = kHeightsM.back(); z >= 0.0; z -= kStepM) {
    place = eye + (z - eye.z()) / ray.z() * ray;
    if (z <= height_m(place.x(), place.y())) break;
  }
  return place;
}

Image TowersBeforeAPlain::render(const PinholeCamera& camera,
                                 const Pose& T_world_camera,
                                 double noise,
                                 std::uint64_t noise_seed) const {
  Image image(camera.width_px, camera.height_px, 1);
  GreyNoise grey_noise(noise, noise_seed);
  const Eigen::Matrix3d R = T_world_camera.rotation.toRotationMatrix();
  const Eigen::Vector3d& eye = T_world_camera.translation;
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const Eigen::Vector3d place = hit(eye, R * camera.ray(Eigen::Vector2d(x, y)));
      // The height is part of the place on the texture, so that walls have one.
      const float grey = texture_.sample(place.x() + 0.7 * place.z(),
                                         place.y() + 0.7 * place.z(),
                                         (eye.z() - place.z()) / camera.fx_px);
      image.at(x, y) =
          static_cast<std::uint8_t>(std::clamp(grey + grey_noise() + 0.5F, 0.0F, 255.0F));
    }
  }
  return image;
}

}  // namespace overfly::odometry::testing
