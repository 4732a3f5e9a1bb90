#include "odometry/feature/map/focal_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

#include "odometry/adjustment/bundle.hpp"

namespace overfly::odometry::feature {
namespace {

constexpr int kMinKeyframes = 10;
constexpr int kMinPoints = 80;
constexpr int kMinSights = 4;
constexpr int kEveryKeyframes = 10;
/// Number of parabola fits, each closer to the minimum.
constexpr int kRounds = 3;
constexpr double kFarthest = 1.5;
/// Evidence with a larger standard deviation is ignored.
constexpr double kMaxSigma = 0.01;
/// Smaller deviations are not a contradiction: patch errors are correlated where the ground's shape
/// or the light misleads them, so the true uncertainty exceeds the noise.
constexpr double kLeastContradiction = 0.03;
/// Number of evaluations with evidence before a verdict.
constexpr int kLooks = 2;

/// The newest keyframes and the points that many of them observe, as a separate bundle.
Bundle bundle_of_newest(const FocalCheckOptions& options, const Map& map) {
  Bundle bundle;
  std::map<int, int> camera_of;
  std::map<int, int> sights_of;
  auto keyframe = map.keyframes().rbegin();
  for (int i = 0; i < options.keyframes && keyframe != map.keyframes().rend(); ++i, ++keyframe) {
    camera_of[keyframe->first] = i;
    bundle.cameras.push_back({keyframe->second.T_camera_vo, i == 0});
    for (const Observation& seen : keyframe->second.observations) ++sights_of[seen.point];
  }
  std::vector<int> ids;
  for (const auto& [id, count] : sights_of) {
    if (count >= kMinSights && map.point(id) != nullptr) ids.push_back(id);
  }
  const std::size_t stride =
      std::max<std::size_t>(1, ids.size() / static_cast<std::size_t>(options.points));
  std::map<int, int> index_of;
  for (std::size_t i = 0; i < ids.size(); i += stride) {
    index_of[ids[i]] = static_cast<int>(bundle.points_vo.size());
    bundle.points_vo.push_back(map.point(ids[i])->position_vo);
  }
  for (const auto& [id, camera] : camera_of) {
    for (const Observation& seen : map.keyframe(id).observations) {
      const auto index = index_of.find(seen.point);
      if (index == index_of.end()) continue;
      bundle.sights.push_back({camera, index->second, seen.pixel, seen.sigma_px});
    }
  }
  return bundle;
}

double largest_rotation_rad(const Bundle& bundle) {
  double largest = 0.0;
  for (const Bundle::Camera& camera : bundle.cameras) {
    largest = std::max(largest,
                       rotation_angle_rad(bundle.cameras.front().T_camera_vo.rotation,
                                          camera.T_camera_vo.rotation));
  }
  return largest;
}

/// Mean squared error at a focal length, after the adjustment.
double error_at(const PinholeCamera& camera, Bundle bundle, double scale) {
  PinholeCamera scaled = camera;
  scaled.fx_px *= scale;
  scaled.fy_px *= scale;
  BundleOptions options;
  options.max_iterations = 20;
  const double rms = adjust(scaled, bundle, options);
  return rms * rms;
}

}  // namespace

std::optional<FocalEvidence> focal_evidence(const PinholeCamera& camera,
                                            const FocalCheckOptions& options,
                                            const Map& map) {
  const Bundle bundle = bundle_of_newest(options, map);
  if (static_cast<int>(bundle.cameras.size()) < kMinKeyframes ||
      static_cast<int>(bundle.points_vo.size()) < kMinPoints ||
      largest_rotation_rad(bundle) < options.min_rotation_rad) {
    return std::nullopt;
  }
  FocalEvidence evidence;
  for (int round = 0; round < kRounds; ++round) {
    const double middle = evidence.scale;
    const double at_middle = error_at(camera, bundle, middle);
    const double smaller = error_at(camera, bundle, middle - options.step);
    const double larger = error_at(camera, bundle, middle + options.step);
    const double bend = smaller + larger - 2.0 * at_middle;
    if (!std::isfinite(bend)) return std::nullopt;
    const double step = bend > 0.0 ? 0.5 * options.step * (smaller - larger) / bend
                                   : std::copysign(kFarthest * options.step, smaller - larger);
    const auto residuals = 2.0 * static_cast<double>(bundle.sights.size());
    evidence.scale += std::clamp(step, -kFarthest * options.step, kFarthest * options.step);
    if (std::abs(step) > options.step) continue;  // the parabola is valid only between its points
    evidence.sigma = options.step * std::sqrt(2.0 * at_middle / (bend * residuals));
    return evidence;
  }
  return std::nullopt;
}

std::optional<std::string> FocalCheck::after_keyframe(const Map& map) {
  const int newest = map.newest().id;
  if (concluded_ || newest < next_keyframe_) return std::nullopt;
  next_keyframe_ = newest + kEveryKeyframes;
  const auto evidence = focal_evidence(camera_, {}, map);
  if (!evidence || evidence->sigma > kMaxSigma) return std::nullopt;
  // Limit the weight of a single evaluation, however small its own noise.
  const double weight = 1.0 / (evidence->sigma * evidence->sigma + 1e-4);
  weight_ += weight;
  weighted_sum_ += weight * evidence->scale;
  if (++looks_ < kLooks) return std::nullopt;
  concluded_ = true;
  const double scale = weighted_sum_ / weight_;
  if (std::abs(scale - 1.0) < kLeastContradiction) return std::nullopt;
  std::ostringstream text;
  text.precision(4);
  text << "warning: the images contradict the calibration: its focal length is " << camera_.fx_px
       << " px, and views that turn agree best at about " << scale * camera_.fx_px << " px ("
       << (scale > 1.0 ? "+" : "") << 100.0 * (scale - 1.0) << " %); check the camera's intrinsics";
  return text.str();
}

}  // namespace overfly::odometry::feature
