#include "odometry/feature/map/relocaliser.hpp"

#include <algorithm>
#include <array>
#include <opencv2/calib3d.hpp>
#include <random>
#include <vector>

#include "odometry/adjustment/pose_optimiser.hpp"

namespace overfly::odometry::feature {
namespace {

std::vector<PoseObservation> match_points(const RelocaliserOptions& options,
                                          const std::vector<Corner>& corners,
                                          OrbExtractor& orb,
                                          const Map& map) {
  const int oldest = map.newest().id - options.keyframes;
  std::vector<const MapPoint*> points;
  std::vector<Descriptor> descriptors;  // side by side: each is compared with every corner
  for (const MapPoint& point : map.points()) {
    if (point.keyframes.back() < oldest) continue;
    points.push_back(&point);
    descriptors.push_back(point.descriptor);
  }
  std::vector<PoseObservation> matches;
  for (const Corner& corner : corners) {
    const Descriptor descriptor = orb.describe(corner);
    int best = 257;
    int second = 257;
    const MapPoint* found = nullptr;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int distance = hamming_distance(descriptor, descriptors[i]);
      if (distance < best) {
        second = best;
        best = distance;
        found = points[i];
      } else if (distance < second) {
        second = distance;
      }
    }
    if (found == nullptr || best > options.max_distance || best > options.ratio * second) continue;
    matches.push_back({found->position_vo, corner.pixel, 1.0});
  }
  return matches;
}

/// Pose from four pairs: three give up to four solutions, the fourth selects one.
std::optional<Pose> pose_of_four(const PinholeCamera& camera,
                                 const std::vector<PoseObservation>& matches,
                                 const std::array<std::size_t, 4>& chosen) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> rays;
  for (const std::size_t i : chosen) {
    const Eigen::Vector3d& p = matches[i].point_vo;
    const Eigen::Vector3d ray = camera.ray(matches[i].pixel);
    points.emplace_back(p.x(), p.y(), p.z());
    rays.emplace_back(ray.x(), ray.y());
  }
  cv::Vec3d rotation;
  cv::Vec3d translation;
  // Does not throw for four points; coincident points give no solution.
  if (!cv::solvePnP(points,
                    rays,
                    cv::Matx33d::eye(),
                    cv::noArray(),
                    rotation,
                    translation,
                    false,
                    cv::SOLVEPNP_AP3P)) {
    return std::nullopt;
  }
  const Pose pose{exp_so3({rotation[0], rotation[1], rotation[2]}),
                  {translation[0], translation[1], translation[2]}};
  if (!pose.translation.allFinite() || !pose.rotation.coeffs().allFinite()) return std::nullopt;
  return pose;
}

bool agrees(const PinholeCamera& camera,
            const PoseObservation& match,
            const Pose& pose,
            double threshold_px) {
  const auto pixel = camera.project(pose * match.point_vo);
  return pixel && (*pixel - match.pixel).norm() < threshold_px;
}

int count_inliers(const PinholeCamera& camera,
                  const std::vector<PoseObservation>& matches,
                  const Pose& pose,
                  double threshold_px) {
  return static_cast<int>(
      std::count_if(matches.begin(), matches.end(), [&](const PoseObservation& match) {
        return agrees(camera, match, pose, threshold_px);
      }));
}

}  // namespace

Relocalisation relocalise(const PinholeCamera& camera,
                          const RelocaliserOptions& options,
                          const cv::Mat& image,
                          OrbExtractor& orb,
                          const Map& map) {
  Relocalisation result;
  const std::vector<Corner> corners = orb.detect(image);
  const std::vector<PoseObservation> matches = match_points(options, corners, orb, map);
  result.matches = static_cast<int>(matches.size());
  if (result.matches < options.min_inliers) return result;
  std::mt19937_64 rng(options.seed);
  int best = 0;
  Pose best_pose;
  for (int round = 0; round < options.rounds; ++round) {
    std::array<std::size_t, 4> chosen{};
    for (std::size_t& index : chosen) index = rng() % matches.size();
    std::sort(chosen.begin(), chosen.end());
    if (std::adjacent_find(chosen.begin(), chosen.end()) != chosen.end()) continue;
    const auto pose = pose_of_four(camera, matches, chosen);
    if (!pose) continue;
    const int inliers = count_inliers(camera, matches, *pose, options.threshold_px);
    if (inliers > best) {
      best = inliers;
      best_pose = *pose;
    }
  }
  if (best < options.min_inliers) return result;
  PoseFitOptions fit_options;
  fit_options.outlier = options.threshold_px;
  std::vector<PoseObservation> agreeing;
  for (const PoseObservation& match : matches) {
    if (agrees(camera, match, best_pose, options.threshold_px)) agreeing.push_back(match);
  }
  result.T_camera_vo = optimise_pose(camera, best_pose, agreeing, fit_options).T_camera_vo;
  return result;
}

}  // namespace overfly::odometry::feature
