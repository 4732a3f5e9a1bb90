#include "renderer/camera/image_motion.hpp"

#include <algorithm>
#include <boost/math/special_functions/legendre.hpp>
#include <cmath>
#include <numeric>

namespace overfly::renderer {

namespace {

constexpr double kInstantPx = 0.25;  // a shorter streak is rendered as an instant
constexpr double kRowsPx = 0.05;
/// Even pieces of time are cut at the poses as well where that finds this many times the motion. A
/// vibration needs it; the motion of an aircraft does not.
constexpr double kOverlooked = 1.05;

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

/// A place of the image, and the direction with z = 1 through it.
struct SeenPlace {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector3d ray = Eigen::Vector3d::Zero();
};

/// The places whose motion is examined.
std::vector<SeenPlace> examined_places(const CameraModel& camera) {
  constexpr int kSteps = 4;
  const PinholeCamera& size = camera.pinhole();
  std::vector<SeenPlace> places;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const Eigen::Vector2d pixel((size.width_px - 1.0) * i / kSteps,
                                  (size.height_px - 1.0) * j / kSteps);
      if (const auto ray = camera.ray(pixel)) places.push_back({pixel, *ray});
    }
  }
  return places;
}

double largest_motion_of(const std::vector<SeenPlace>& places,
                         const CameraModel& camera,
                         const Pose& T_world_camera_before,
                         const Pose& T_world_camera_after,
                         const HeightQuery& ground) {
  constexpr double kFarM = 1e6;
  const Eigen::Vector3d& at = T_world_camera_before.translation;
  const double height_m = std::max(at.z() - ground.ground_up_m(at.x(), at.y()), 1.0);
  const Pose T_after_before = T_world_camera_after.inverse() * T_world_camera_before;
  double largest_px = 0.0;
  for (const SeenPlace& place : places) {
    const double descent = -(T_world_camera_before.rotation * place.ray).z();
    const double depth_m = descent > height_m / kFarM ? height_m / descent : kFarM;
    const auto moved = camera.project(T_after_before * Eigen::Vector3d(depth_m * place.ray));
    if (moved) largest_px = std::max(largest_px, (*moved - place.pixel).norm());
  }
  return largest_px;
}

/// The limits of pieces of time together with the times of the poses between them; increasing.
std::vector<std::int64_t> cut_at_poses(std::vector<std::int64_t> limits_ns,
                                       const CameraMotion& motion) {
  const std::int64_t first_ns = limits_ns.front();
  const std::int64_t last_ns = limits_ns.back();
  for (const StampedPose& stamped : motion.poses()) {
    if (stamped.t_ns > first_ns && stamped.t_ns < last_ns) limits_ns.push_back(stamped.t_ns);
  }
  std::sort(limits_ns.begin(), limits_ns.end());
  limits_ns.erase(std::unique(limits_ns.begin(), limits_ns.end()), limits_ns.end());
  return limits_ns;
}

/// The largest motion in each piece of time between two neighbouring limits [px].
std::vector<double> motion_px(const CameraRequest& request,
                              const HeightQuery& ground,
                              const std::vector<std::int64_t>& limits_ns) {
  const std::vector<SeenPlace> places = examined_places(request.camera);
  std::vector<double> pieces_px;
  Pose before = request.T_world_camera.at(limits_ns.front());
  for (std::size_t i = 1; i < limits_ns.size(); ++i) {
    const Pose after = request.T_world_camera.at(limits_ns[i]);
    pieces_px.push_back(largest_motion_of(places, request.camera, before, after, ground));
    before = after;
  }
  return pieces_px;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

double largest_motion_px(const CameraModel& camera,
                         const Pose& T_world_camera_before,
                         const Pose& T_world_camera_after,
                         const HeightQuery& ground) {
  return largest_motion_of(
      examined_places(camera), camera, T_world_camera_before, T_world_camera_after, ground);
}

std::vector<ExposureInstant> exposure_instants(const CameraRequest& request,
                                               const HeightQuery& ground) {
  if (request.exposure_ns == 0 || request.T_world_camera.still()) return {{}};
  // Sums the motion in both directions, because a vibration may return within the exposure.
  constexpr int kPieces = 8;
  const std::int64_t from_ns = request.t_ns - request.readout_ns / 2 - request.exposure_ns / 2;
  const std::int64_t all_ns = request.readout_ns + request.exposure_ns;
  std::vector<std::int64_t> limits_ns;
  for (int i = 0; i <= kPieces; ++i) limits_ns.push_back(from_ns + all_ns * i / kPieces);
  double streak_px = sum_of(motion_px(request, ground, limits_ns));
  const double cut_px =
      sum_of(motion_px(request, ground, cut_at_poses(limits_ns, request.T_world_camera)));
  if (cut_px > kOverlooked * streak_px) streak_px = cut_px;
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
  std::vector<std::int64_t> limits_ns;
  for (int i = 0; i <= kPieces; ++i) {
    limits_ns.push_back(request.row_time_ns((rows - 1.0) * i / kPieces));
  }
  const std::vector<double> even_px = motion_px(request, ground, limits_ns);
  double px_per_row = *std::max_element(even_px.begin(), even_px.end()) * kPieces / (rows - 1.0);
  const std::vector<std::int64_t> cuts_ns = cut_at_poses(limits_ns, request.T_world_camera);
  const std::vector<double> cut_px = motion_px(request, ground, cuts_ns);
  const double row_ns = static_cast<double>(request.readout_ns) / (rows - 1.0);
  double cut_px_per_row = 0.0;
  for (std::size_t i = 0; i < cut_px.size(); ++i) {
    const auto piece_ns = static_cast<double>(cuts_ns[i + 1] - cuts_ns[i]);
    cut_px_per_row = std::max(cut_px_per_row, cut_px[i] / piece_ns * row_ns);
  }
  if (cut_px_per_row > kOverlooked * px_per_row) px_per_row = cut_px_per_row;
  if (px_per_row * 0.5 * rows <= kRowsPx) return rows;
  return std::clamp(static_cast<int>(2.0 * kRowsPx / px_per_row), 1, rows);
}

}  // namespace overfly::renderer
