// The ground's local shape from the map's points: planes, patch tangents and depth.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "odometry/feature/map/map.hpp"

namespace overfly::odometry::feature {
namespace {

constexpr int kMinPlanePoints = 20;
constexpr int kMinAxisPoints = 15;
/// Points closer to the axis than this, as a fraction of their depth, count as near it.
constexpr double kAxisTangent = 0.2;
/// Points whose inverse depth differs from the plane's by a smaller fraction lie near the plane.
constexpr double kNearPlane = 0.3;
/// If a smaller share of points lies near the plane, the scene is not planar: a street, a wood, a
/// room.
constexpr double kLeastShareNear = 0.5;
/// Share of points needed to treat the scene as planar again.
constexpr double kShareNearAgain = 0.85;

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct DepthSample {
  Eigen::Vector3d ray;
  double inverse_depth = 0.0;
};

/// Fits a plane (as in GroundPlane) to samples by iteratively reweighted least squares with Cauchy
/// weights on the relative depth error.
Eigen::Vector3d plane_of(const std::vector<DepthSample>& samples) {
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  for (int iteration = 0; iteration < 6; ++iteration) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const auto& [ray, inverse_depth] : samples) {
      const double error = (plane.dot(ray) - inverse_depth) / inverse_depth;
      const double weight = (iteration == 0 ? 1.0 : 1.0 / (1.0 + std::pow(error / 0.05, 2))) /
                            (inverse_depth * inverse_depth);
      H += weight * ray * ray.transpose();
      b += weight * inverse_depth * ray;
    }
    plane = H.ldlt().solve(b);
  }
  return plane;
}

/// Share of the samples near the plane.
double share_near(const std::vector<DepthSample>& samples, const Eigen::Vector3d& plane) {
  const auto near = std::count_if(samples.begin(), samples.end(), [&](const DepthSample& sample) {
    return std::abs(plane.dot(sample.ray) - sample.inverse_depth) <
           kNearPlane * sample.inverse_depth;
  });
  return static_cast<double>(near) / static_cast<double>(samples.size());
}

}  // namespace

void set_normal(const PinholeCamera& camera, const Keyframe& source, MapPoint& point) {
  const Eigen::Vector3d ray = camera.ray(point.source_pixel);
  const Eigen::Vector3d& n = source.plane.coefficients;
  // A plane seen edge-on is unusable: use one that faces the camera.
  const bool grazing = n.dot(ray) < 0.15 * n.norm() * ray.norm();
  const Eigen::Vector3d normal = grazing ? Eigen::Vector3d::UnitZ() : n.normalized();
  point.normal_vo = source.T_camera_vo.rotation.inverse() * normal;
}

void fit_plane(const PinholeCamera& camera, const Map& map, Keyframe& keyframe) {
  std::vector<DepthSample> samples;
  for (const Observation& seen : keyframe.observations) {
    const MapPoint* point = map.point(seen.point);
    if (point == nullptr) continue;
    const double depth = (keyframe.T_camera_vo * point->position_vo).z();
    if (depth > 1e-6) samples.push_back({camera.ray(seen.pixel), 1.0 / depth});
  }
  if (samples.size() < kMinPlanePoints) return;
  const Eigen::Vector3d plane = plane_of(samples);
  if (plane.allFinite() && plane.z() > 0.0) keyframe.plane.coefficients = plane;
  const double asked = keyframe.plane.holds ? kLeastShareNear : kShareNearAgain;
  keyframe.plane.holds = share_near(samples, keyframe.plane.coefficients) > asked;
  std::vector<double> depths;
  depths.reserve(samples.size());
  for (const DepthSample& sample : samples) depths.push_back(1.0 / sample.inverse_depth);
  keyframe.plane.median_depth = median_of(depths);
}

std::optional<double> axis_depth(const Pose& T_camera_vo,
                                 const std::vector<Eigen::Vector3d>& points_vo) {
  std::vector<DepthSample> near_axis;
  std::vector<double> all;
  for (const Eigen::Vector3d& point : points_vo) {
    const Eigen::Vector3d p = T_camera_vo * point;
    if (p.z() <= 0.0) continue;
    all.push_back(p.z());
    if (p.head<2>().norm() < kAxisTangent * p.z()) near_axis.push_back({p / p.z(), 1.0 / p.z()});
  }
  if (all.empty()) return std::nullopt;
  if (near_axis.size() >= kMinAxisPoints) {
    const Eigen::Vector3d plane = plane_of(near_axis);
    if (plane.allFinite() && plane.z() > 0.0) return 1.0 / plane.z();
  }
  return median_of(all);
}

}  // namespace overfly::odometry::feature
