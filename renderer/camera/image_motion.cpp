#include "renderer/camera/image_motion.hpp"

#include <algorithm>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>

namespace overfly::renderer {

namespace {

constexpr double kInstantPx = 0.25;  // a shorter streak is rendered as an instant
constexpr double kRowsPx = 0.05;

/// Gauss-Legendre quadrature (Abramowitz and Stegun 1964, eq. 25.4.29).
std::vector<ExposureInstant> quadrature(int instants, std::int64_t exposure_ns) {
  std::vector<ExposureInstant> all;
  const auto add = [&](double root, double weight) {
    all.push_back({std::llround(0.5 * root * static_cast<double>(exposure_ns)),
                   static_cast<float>(0.5 * weight)});
  };
  for (const double root : boost::math::legendre_p_zeros<double>(instants)) {
    const double slope = boost::math::legendre_p_prime(instants, root);
    const double weight = 2.0 / ((1.0 - root * root) * slope * slope);
    if (root > 0.0) add(-root, weight);
    add(root, weight);
  }
  std::sort(all.begin(), all.end(), [](const ExposureInstant& a, const ExposureInstant& b) {
    return a.offset_ns < b.offset_ns;
  });
  return all;
}

}  // namespace

double largest_motion_px(const CameraModel& camera,
                         const Pose& T_world_camera_before,
                         const Pose& T_world_camera_after,
                         const HeightQuery& ground) {
  constexpr int kSteps = 4;
  constexpr double kFarM = 1e6;
  const Eigen::Vector3d& at = T_world_camera_before.translation;
  const double height_m = std::max(at.z() - ground.ground_up_m(at.x(), at.y()), 1.0);
  const Pose T_after_before = T_world_camera_after.inverse() * T_world_camera_before;
  const PinholeCamera& size = camera.pinhole();
  double largest_px = 0.0;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const Eigen::Vector2d pixel((size.width_px - 1.0) * i / kSteps,
                                  (size.height_px - 1.0) * j / kSteps);
      const std::optional<Eigen::Vector3d> ray = camera.ray(pixel);
      if (!ray) continue;
      const double descent = -(T_world_camera_before.rotation * *ray).z();
      const double depth_m = descent > height_m / kFarM ? height_m / descent : kFarM;
      const auto moved = camera.project(T_after_before * Eigen::Vector3d(depth_m * *ray));
      if (moved) largest_px = std::max(largest_px, (*moved - pixel).norm());
    }
  }
  return largest_px;
}

std::vector<ExposureInstant> exposure_instants(const CameraRequest& request,
                                               const HeightQuery& ground) {
  if (request.exposure_ns == 0 || request.T_world_camera.still()) return {{}};
  const auto pose = [&](std::int64_t t_ns) { return request.T_world_camera.at(t_ns); };
  // Sums the motion in both directions, because a vibration may return within the exposure.
  constexpr int kPieces = 8;
  double streak_px = 0.0;
  const std::int64_t from_ns = request.t_ns - request.readout_ns / 2 - request.exposure_ns / 2;
  const std::int64_t all_ns = request.readout_ns + request.exposure_ns;
  for (int i = 0; i < kPieces; ++i) {
    streak_px += largest_motion_px(request.camera,
                                   pose(from_ns + all_ns * i / kPieces),
                                   pose(from_ns + all_ns * (i + 1) / kPieces),
                                   ground);
  }
  streak_px *= static_cast<double>(request.exposure_ns) / static_cast<double>(all_ns);
  if (streak_px < kInstantPx) return {{}};
  // Limited before the conversion: a point next to the image plane moves by any number of pixels.
  const double instants = std::min(std::ceil(streak_px) + 1.0, 1.0 * kMaxInstants);
  return quadrature(static_cast<int>(instants), request.exposure_ns);
}

int rows_of_one_pose(const CameraRequest& request, const HeightQuery& ground) {
  const int rows = request.camera.pinhole().height_px;
  if (request.readout_ns == 0 || request.T_world_camera.still() || rows < 2) return rows;
  constexpr int kPieces = 16;
  double fastest_px = 0.0;  // over a piece of the readout
  for (int i = 0; i < kPieces; ++i) {
    const auto time_ns = [&](int piece) {
      return request.row_time_ns((rows - 1.0) * piece / kPieces);
    };
    fastest_px = std::max(fastest_px,
                          largest_motion_px(request.camera,
                                            request.T_world_camera.at(time_ns(i)),
                                            request.T_world_camera.at(time_ns(i + 1)),
                                            ground));
  }
  const double px_per_row = fastest_px * kPieces / (rows - 1.0);
  if (px_per_row * 0.5 * rows <= kRowsPx) return rows;
  return std::clamp(static_cast<int>(2.0 * kRowsPx / px_per_row), 1, rows);
}

}  // namespace overfly::renderer
