#include "odometry/feature/map/mapper.hpp"

#include <algorithm>
#include <cmath>

#include "odometry/geometry/triangulation.hpp"
#include "odometry/image/patch_aligner.hpp"
#include "odometry/shell/stage_stopwatch.hpp"

namespace overfly::odometry::feature {
namespace {

constexpr float kMinMapCorrelation = 0.8F;
constexpr int kMaxMisses = 3;
/// Maximum ratio of a new point's depth to the ground plane's; beyond it the match is wrong.
constexpr double kMaxDepthRatio = 2.5;
/// Ground farther away than this many median depths gives no parallax while it is in view.
constexpr double kMaxRelativeDepth = 6.0;
constexpr int kExpectedBeforeCulling = 12;
/// For scenes with occlusions and images far apart.
constexpr int kExpectedBeforeCullingInScene = 5;
constexpr double kMinFoundShare = 0.25;

Eigen::Vector3d centre_of(const Pose& T_camera_vo) { return T_camera_vo.inverse().translation; }

}  // namespace

Mapper::Mapper(const PinholeCamera& camera, const MapperOptions& options)
    : camera_(camera), options_(options) {}

bool Mapper::wants_keyframe(const FrameImage& frame,
                            const TrackResult& tracked,
                            const Map& map) const {
  const Keyframe& last = map.newest();
  if (frame.index - last.frame < (last.plane.holds ? options_.min_frames_between : 1)) return false;
  const double turned = rotation_angle_rad(tracked.T_camera_vo.rotation, last.T_camera_vo.rotation);
  if (turned > options_.max_rotation_rad) return true;
  const double moved = (centre_of(tracked.T_camera_vo) - centre_of(last.T_camera_vo)).norm();
  const double depth = last.plane.holds ? 1.0 / std::max(last.plane.coefficients.z(), 1e-6)
                                        : last.plane.median_depth;
  if (moved > options_.max_translation * depth) return true;
  return static_cast<double>(tracked.points.size()) <
         options_.min_tracked_share * static_cast<double>(last.observations.size());
}

void Mapper::extend(const FrameImage& frame,
                    const TrackResult& tracked,
                    Map& map,
                    std::map<std::string, double>& timing_ms) const {
  const StageStopwatch stopwatch(timing_ms, "triangulation");
  Keyframe made;
  made.frame = frame.index;
  made.t_ns = frame.t_ns;
  made.T_camera_vo = tracked.T_camera_vo;
  made.pyramid = frame.pyramid;
  made.plane = map.newest().plane;
  Keyframe& keyframe = map.add_keyframe(std::move(made));
  for (const TrackedPoint& seen : tracked.points) {
    // A copy of the map may contain points that were removed.
    if (map.point(seen.point) == nullptr) continue;
    map.add_observation(keyframe, {seen.point, seen.pixel, seen.sigma_px});
  }
  fit_plane(camera_, map, keyframe);
  triangulate_candidates(map);
}

void Mapper::refine(OrbExtractor& orb, Map& map, std::map<std::string, double>& timing_ms) const {
  {
    const StageStopwatch stopwatch(timing_ms, "bundle_adjustment");
    adjust_locally(camera_, options_.adjustment, map);
    cull(map);
    fit_plane(camera_, map, map.newest());
  }
  {
    const StageStopwatch stopwatch(timing_ms, "features");
    add_candidates(orb, map);
  }
  map.forget_images(options_.images_kept);
}

void Mapper::add_candidates(OrbExtractor& orb, Map& map) const {
  Keyframe& keyframe = map.newest();
  CellGrid empty = CellGrid::over(camera_.width_px, camera_.height_px, options_.cells);
  std::fill(empty.marked.begin(), empty.marked.end(), std::uint8_t{1});
  for (const Observation& seen : keyframe.observations) empty.marked[empty.index(seen.pixel)] = 0;
  const double usual = keyframe.plane.coefficients.z();
  const std::vector<Corner> corners = orb.detect(keyframe.pyramid.level(0), &empty);
  std::vector<const Corner*> best(empty.marked.size(), nullptr);
  for (const Corner& corner : corners) {
    const std::size_t cell = empty.index(corner.pixel);
    const double inverse_depth = keyframe.plane.inverse_depth(camera_.ray(corner.pixel));
    const bool too_far = keyframe.plane.holds && inverse_depth * kMaxRelativeDepth < usual;
    if (empty.marked[cell] == 0 || too_far) continue;
    if (keyframe.pyramid.burnt_at(corner.pixel)) continue;
    if (best[cell] == nullptr || corner.response > best[cell]->response) best[cell] = &corner;
  }
  for (const Corner* corner : best) {
    if (corner == nullptr) continue;
    const auto level = textured_level(keyframe.pyramid,
                                      corner->pixel,
                                      patch_level_of(corner->scale_level, options_.scale_factor),
                                      options_.coarsest_patch_level);
    if (level) keyframe.candidates.push_back({*corner, orb.describe(*corner), *level, 0, false});
  }
}

void Mapper::triangulate_candidates(Map& map) const {
  const int newest = map.newest().id;
  for (auto& [id, source] : map.keyframes()) {
    if (id < newest - options_.candidate_keyframes || id == newest) continue;
    for (Candidate& candidate : source.candidates) {
      if (candidate.done) continue;
      const Search search = triangulate_candidate(source, candidate, map);
      if (search == Search::kMissed) ++candidate.misses;
      candidate.done =
          search == Search::kFound || search == Search::kFused || candidate.misses >= kMaxMisses;
    }
  }
}

Mapper::Search Mapper::triangulate_candidate(const Keyframe& source,
                                             const Candidate& candidate,
                                             Map& map) const {
  if (!source.plane.holds) return triangulate_in_scene(source, candidate, map);
  const int patch_level = candidate.patch_level;
  Keyframe& newest = map.newest();
  const Eigen::Vector3d ray = camera_.ray(candidate.corner.pixel);
  const double prior = 1.0 / source.plane.inverse_depth(ray);
  if (!(prior > 0.0)) return Search::kMissed;
  const Pose T_vo_source = source.T_camera_vo.inverse();
  MapPoint point;
  point.position_vo = T_vo_source * (prior * ray);
  point.source_keyframe = source.id;
  point.source_pixel = candidate.corner.pixel;
  point.patch_level = patch_level;
  point.descriptor = candidate.descriptor;
  set_normal(camera_, source, point);
  const auto expected = camera_.project(newest.T_camera_vo * point.position_vo);
  if (!expected) return Search::kMissed;
  const PatchWarp warp = warp_of(camera_, newest.T_camera_vo, source, point);
  // Search coarse to fine, because the ground is not exactly a plane.
  Eigen::Vector2d pixel = *expected;
  for (int level = patch_level + 2; level >= patch_level; --level) {
    const auto patch = make_template(source.pyramid, point.source_pixel, warp, level);
    const auto match = patch ? align_patch(newest.pyramid, *patch, pixel) : std::nullopt;
    const bool good = match && match->correlation > kMinMapCorrelation;
    if (!good && level == patch_level) return Search::kMissed;
    if (good) pixel = match->pixel;
  }
  if (const MapPoint* known = point_at(map, newest, pixel, patch_level)) {
    fuse(*known, source, map);
    return Search::kFused;
  }
  const Pose T_newest_source = newest.T_camera_vo * T_vo_source;
  const auto triangulated = triangulate(ray, camera_.ray(pixel), T_newest_source);
  if (!triangulated) return Search::kTooNear;
  if (triangulated->parallax_rad < options_.min_parallax_rad) return Search::kTooNear;
  const double ratio = triangulated->p_first.z() / prior;
  if (ratio > kMaxDepthRatio || ratio * kMaxDepthRatio < 1.0) return Search::kMissed;
  const auto again = camera_.project(T_newest_source * triangulated->p_first);
  if (!again || (*again - pixel).norm() > std::ldexp(options_.max_epipolar_px, patch_level)) {
    return Search::kMissed;
  }
  point.position_vo = T_vo_source * triangulated->p_first;
  set_normal(camera_, source, point);
  add(point, pixel, map);
  return Search::kFound;
}

/// Adds a point observed in its source and the newest keyframe, and searches it in those between.
void Mapper::add(const MapPoint& point, const Eigen::Vector2d& newest_pixel, Map& map) const {
  Keyframe& newest = map.newest();
  const double sigma_px = sigma_px_of(point.patch_level);
  const MapPoint& added = map.add_point(point);
  map.add_observation(map.keyframe(point.source_keyframe),
                      {added.id, point.source_pixel, sigma_px});
  map.add_observation(newest, {added.id, newest_pixel, sigma_px});
  for (int id = point.source_keyframe + 1; id < newest.id; ++id) {
    observe(added, map.keyframe(id), map);
  }
}

void Mapper::fuse(const MapPoint& known, const Keyframe& source, Map& map) const {
  const std::vector<int>& seen_from = known.keyframes;
  if (std::binary_search(seen_from.begin(), seen_from.end(), source.id)) return;
  observe(known, map.keyframe(source.id), map);
}

void Mapper::observe(const MapPoint& point, Keyframe& keyframe, Map& map) const {
  const auto expected = camera_.project(keyframe.T_camera_vo * point.position_vo);
  if (!expected) return;
  const Keyframe& source = map.keyframe(point.source_keyframe);
  const auto patch = make_template(source.pyramid,
                                   point.source_pixel,
                                   warp_of(camera_, keyframe.T_camera_vo, source, point),
                                   point.patch_level);
  const auto match = patch ? align_patch(keyframe.pyramid, *patch, *expected) : std::nullopt;
  if (!match || match->correlation < kMinMapCorrelation) return;
  if ((match->pixel - *expected).norm() > std::ldexp(1.5, point.patch_level)) return;
  map.add_observation(keyframe, {point.id, match->pixel, sigma_px_of(point.patch_level)});
}

/// Removes points that are too rarely found where they are expected.
void Mapper::cull(Map& map) const {
  const int enough =
      map.newest().plane.holds ? kExpectedBeforeCulling : kExpectedBeforeCullingInScene;
  std::vector<int> gone;
  for (const MapPoint& point : map.points()) {
    if (point.expected >= enough && point.found < kMinFoundShare * point.expected) {
      gone.push_back(point.id);
    }
  }
  for (const int id : gone) map.remove_point(id);
}

}  // namespace overfly::odometry::feature
