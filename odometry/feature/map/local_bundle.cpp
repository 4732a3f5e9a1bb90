#include "odometry/feature/map/local_bundle.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace overfly::odometry::feature {
namespace {

/// A bundle and the map ids of its members.
struct Window {
  Bundle bundle;
  std::vector<int> keyframes;    ///< id of each camera
  std::vector<int> points;       ///< id of each point
  std::map<int, int> camera_of;  ///< keyframe id -> camera
};

std::set<int> free_keyframes(const LocalAdjustment& options, const Map& map) {
  const int newest = map.newest().id;
  std::set<int> ids{newest};
  for (const int id : map.covisible(newest, 15)) {
    if (static_cast<int>(ids.size()) >= options.free_keyframes) break;
    ids.insert(id);
  }
  // The first keyframe is the origin.
  if (ids.size() > 1) ids.erase(map.keyframes().begin()->first);
  return ids;
}

/// Keyframes outside `free` that share most observations of the points, up to the limit.
std::vector<int> fixed_keyframes(const LocalAdjustment& options,
                                 const Map& map,
                                 const std::set<int>& free,
                                 const std::set<int>& points) {
  std::map<int, int> sights;
  for (const int id : points) {
    for (const int keyframe : map.point(id)->keyframes) {
      if (!free.contains(keyframe)) ++sights[keyframe];
    }
  }
  std::vector<std::pair<int, int>> ranked;
  ranked.reserve(sights.size());
  for (const auto& [id, count] : sights) ranked.emplace_back(count, id);
  std::sort(ranked.rbegin(), ranked.rend());
  std::vector<int> ids;
  for (const auto& [count, id] : ranked) {
    if (static_cast<int>(ids.size()) >= options.fixed_keyframes) break;
    ids.push_back(id);
  }
  return ids;
}

Window make_window(const LocalAdjustment& options, const Map& map) {
  const std::set<int> free = free_keyframes(options, map);
  std::set<int> points;
  for (const int id : free) {
    for (const Observation& seen : map.keyframe(id).observations) points.insert(seen.point);
  }
  Window window;
  const auto add_camera = [&](int id, bool fixed) {
    window.camera_of[id] = static_cast<int>(window.keyframes.size());
    window.keyframes.push_back(id);
    window.bundle.cameras.push_back({map.keyframe(id).T_camera_vo, fixed});
  };
  for (const int id : free) add_camera(id, false);
  for (const int id : fixed_keyframes(options, map, free, points)) add_camera(id, true);
  std::map<int, int> index_of;
  for (const int id : points) {
    index_of[id] = static_cast<int>(window.points.size());
    window.points.push_back(id);
    window.bundle.points_vo.push_back(map.point(id)->position_vo);
  }
  for (const int id : window.keyframes) {
    for (const Observation& seen : map.keyframe(id).observations) {
      const auto point = index_of.find(seen.point);
      if (point == index_of.end()) continue;
      window.bundle.sights.push_back(
          {window.camera_of[id], point->second, seen.pixel, seen.sigma_px});
    }
  }
  return window;
}

/// Writes the result back and removes observations that do not agree with it.
void apply(const PinholeCamera& camera, const Window& window, double outlier, Map& map) {
  const Bundle& bundle = window.bundle;
  for (std::size_t i = 0; i < window.keyframes.size(); ++i) {
    map.keyframe(window.keyframes[i]).T_camera_vo = bundle.cameras[i].T_camera_vo;
  }
  for (std::size_t i = 0; i < window.points.size(); ++i) {
    map.point(window.points[i])->position_vo = bundle.points_vo[i];
  }
  for (const Bundle::Sight& sight : bundle.sights) {
    const auto camera_index = static_cast<std::size_t>(sight.camera);
    const auto point_index = static_cast<std::size_t>(sight.point);
    const auto pixel =
        camera.project(bundle.cameras[camera_index].T_camera_vo * bundle.points_vo[point_index]);
    if (!pixel || (*pixel - sight.pixel).norm() > outlier * sight.sigma_px) {
      map.remove_observation(window.keyframes[camera_index], window.points[point_index]);
    }
  }
}

}  // namespace

void adjust_locally(const PinholeCamera& camera, const LocalAdjustment& options, Map& map) {
  Window window = make_window(options, map);
  if (window.bundle.sights.size() < 20) return;
  adjust(camera, window.bundle, options.solver);
  apply(camera, window, options.outlier, map);
}

}  // namespace overfly::odometry::feature
