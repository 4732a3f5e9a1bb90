#include "tests/odometry/street_scene.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/odometry/grey_noise.hpp"

namespace overfly::odometry::testing {
namespace {

constexpr double kCameraHeightM = 1.65;
constexpr double kStreetM = 160.0;
constexpr double kFarM = 1e6;

/// A camera that looks along the road: x east, y down, z north.
Eigen::Quaterniond forward() {
  Eigen::Matrix3d R;
  R << 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0;
  return Eigen::Quaterniond(R);
}

}  // namespace

Street::Street(std::uint64_t seed) : texture_(SyntheticGround::procedural(seed, 1024, 0.02, 0.0)) {
  std::mt19937_64 rng(seed);
  const auto uniform = [&] { return static_cast<double>(rng() >> 11U) * 0x1.0p-53; };
  for (const double side : {-1.0, 1.0}) {
    for (double south = -20.0; south < kStreetM;) {
      const double length = 6.0 + 10.0 * uniform();
      const double near = 5.0 + 5.0 * uniform();
      const double height = 4.0 + 8.0 * uniform();
      const double far = near + 8.0;
      houses_.push_back({std::min(side * near, side * far),
                         std::max(side * near, side * far),
                         south,
                         south + length,
                         height});
      south += length + 3.0 * uniform();
    }
  }
}

Street::Hit Street::cast(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) const {
  Hit hit{kFarM};
  if (ray.z() < 0.0) {
    const double along = -eye.z() / ray.z();
    hit = {along, (eye + along * ray).head<2>(), -ray.z()};
  }
  for (const House& house : houses_) {
    // The wall along the road, seen from the road.
    const double wall = house.west_m > 0.0 ? house.west_m : house.east_m;
    const double to_wall = (wall - eye.x()) / ray.x();
    if (to_wall > 0.0 && to_wall < hit.along) {
      const Eigen::Vector3d p = eye + to_wall * ray;
      if (p.y() >= house.south_m && p.y() <= house.north_m && p.z() >= 0.0 &&
          p.z() <= house.height_m) {
        hit = {to_wall, {p.y() + 7.3 * wall, p.z()}, std::abs(ray.x())};
      }
    }
    // The wall that faces south.
    const double to_front = (house.south_m - eye.y()) / ray.y();
    if (to_front > 0.0 && to_front < hit.along) {
      const Eigen::Vector3d p = eye + to_front * ray;
      if (p.x() >= house.west_m && p.x() <= house.east_m && p.z() >= 0.0 &&
          p.z() <= house.height_m) {
        hit = {to_front, {p.x() + 3.1 * house.south_m, p.z() + 11.0}, std::abs(ray.y())};
      }
    }
  }
  return hit;
}

Image Street::render(const PinholeCamera& camera,
                     const Pose& T_world_camera,
                     double noise,
                     std::uint64_t noise_seed) const {
  Image image(camera.width_px, camera.height_px, 1, 0);
  GreyNoise grey_noise(noise, noise_seed);
  const Eigen::Matrix3d R = T_world_camera.rotation.toRotationMatrix();
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const Eigen::Vector3d ray = R * camera.ray(Eigen::Vector2d(x, y)).normalized();
      const Hit hit = cast(T_world_camera.translation, ray);
      double value = 215.0;  // sky
      if (hit.along < kFarM) {
        const double footprint_m = hit.along / camera.fx_px / std::sqrt(std::max(hit.cosine, 0.02));
        value = texture_.sample(hit.place_m.x(), hit.place_m.y(), footprint_m);
      }
      image.at(x, y) =
          static_cast<std::uint8_t>(std::clamp(value + grey_noise() + 0.5, 0.0, 255.0));
    }
  }
  return image;
}

std::vector<Pose> drive(const DriveOptions& options) {
  std::vector<Pose> poses;
  Eigen::Vector3d position(0.0, 0.0, kCameraHeightM);
  const auto frames = static_cast<int>(options.duration_s * options.rate_hz);
  double yaw = 0.0;
  for (int i = 0; i < frames; ++i) {
    const double t_s = i / options.rate_hz;
    const double pitch = 0.006 * std::sin(4.0 * t_s);
    const Eigen::Quaterniond R_world_yaw(Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()));
    const Eigen::Quaterniond R_nod(Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()));
    poses.push_back({(R_world_yaw * R_nod * forward()).normalized(), position});
    position +=
        options.speed_m_s / options.rate_hz * Eigen::Vector3d(std::sin(yaw), std::cos(yaw), 0.0);
    yaw += options.yaw_rad_s * std::cos(1.2 * t_s) / options.rate_hz;
  }
  return poses;
}

PinholeCamera street_camera() {
  return PinholeCamera::from_fov(1242, 375, kPi / 2.0, FovAxis::kHorizontal).value();
}

}  // namespace overfly::odometry::testing
