// Creates points in scenes that are not planar: the initial depth comes from neighbouring points.
#include <algorithm>
#include <cmath>
#include <vector>

#include "odometry/feature/map/mapper.hpp"
#include "odometry/feature/surface_patch.hpp"
#include "odometry/geometry/triangulation.hpp"

namespace overfly::odometry::feature {
namespace {

constexpr std::size_t kNeighbours = 3;
/// Depths that differ by a smaller ratio lead the search to the same result.
constexpr double kSameDepthRatio = 1.25;
/// Multiple of the median depth, for objects behind all neighbours.
constexpr double kFarRatio = 4.0;
constexpr int kCoarserLevels = 2;

/// Candidate depths of a corner of a keyframe, likeliest first: those of neighbouring points in the
/// image, the median, and a far one.
std::vector<double> likely_depths(const Map& map,
                                  const Keyframe& source,
                                  const Eigen::Vector2d& pixel) {
  struct Neighbour {
    double distance2 = 0.0;
    double depth = 0.0;
  };
  std::vector<Neighbour> near;
  for (const Observation& seen : source.observations) {
    const MapPoint* point = map.point(seen.point);
    if (point == nullptr) continue;
    const double depth = (source.T_camera_vo * point->position_vo).z();
    if (depth > 0.0) near.push_back({(seen.pixel - pixel).squaredNorm(), depth});
  }
  const auto kept = near.begin() + static_cast<std::ptrdiff_t>(std::min(kNeighbours, near.size()));
  std::partial_sort(near.begin(), kept, near.end(), [](const Neighbour& a, const Neighbour& b) {
    return a.distance2 < b.distance2;
  });
  std::vector<double> depths;
  const auto add = [&](double depth) {
    const bool known = std::any_of(depths.begin(), depths.end(), [depth](double other) {
      return std::max(depth / other, other / depth) < kSameDepthRatio;
    });
    if (!known) depths.push_back(depth);
  };
  std::for_each(near.begin(), kept, [&](const Neighbour& neighbour) { add(neighbour.depth); });
  add(source.plane.median_depth);
  add(kFarRatio * source.plane.median_depth);
  return depths;
}

}  // namespace

Mapper::Search Mapper::triangulate_in_scene(const Keyframe& source,
                                            const Candidate& candidate,
                                            Map& map) const {
  const Keyframe& newest = map.newest();
  const Eigen::Vector2d& corner = candidate.corner.pixel;
  const Eigen::Vector3d ray = camera_.ray(corner);
  const Pose T_vo_source = source.T_camera_vo.inverse();
  const Pose T_newest_source = newest.T_camera_vo * T_vo_source;
  Search outcome = Search::kMissed;
  for (const double depth : likely_depths(map, source, corner)) {
    const SurfacePoint guess{&source.pyramid, corner, depth * ray, candidate.patch_level};
    const auto found =
        align_on_surface(camera_, guess, T_newest_source, newest.pyramid, kCoarserLevels);
    if (!found) continue;
    const Eigen::Vector2d& pixel = found->match.pixel;
    const auto triangulated = triangulate(ray, camera_.ray(pixel), T_newest_source);
    if (!triangulated || triangulated->parallax_rad < options_.min_parallax_rad) {
      outcome = Search::kTooNear;
      continue;
    }
    const auto again = camera_.project(T_newest_source * triangulated->p_first);
    if (!again ||
        (*again - pixel).norm() > std::ldexp(options_.max_epipolar_px, guess.patch_level)) {
      continue;
    }
    if (const MapPoint* known = point_at(map, newest, pixel, guess.patch_level)) {
      fuse(*known, source, map);
      return Search::kFused;
    }
    MapPoint point;
    point.position_vo = T_vo_source * triangulated->p_first;
    point.normal_vo = T_vo_source.rotation * found->normal_source;
    point.source_keyframe = source.id;
    point.source_pixel = corner;
    point.patch_level = candidate.patch_level;
    point.descriptor = candidate.descriptor;
    add(point, pixel, map);
    return Search::kFound;
  }
  return outcome;
}

}  // namespace overfly::odometry::feature
