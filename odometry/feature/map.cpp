#include "odometry/feature/map.hpp"

#include <algorithm>
#include <utility>

namespace overfly::odometry {

Keyframe& Map::add_keyframe(Keyframe keyframe) {
  keyframe.id = next_keyframe_++;
  const int id = keyframe.id;
  return keyframes_.emplace(id, std::move(keyframe)).first->second;
}

MapPoint& Map::add_point(MapPoint point) {
  point.id = next_point_++;
  const int id = point.id;
  return points_.emplace_hint(points_.end(), id, std::move(point))->second;
}

void Map::add_observation(Keyframe& keyframe, const Observation& observation) {
  keyframe.observations.push_back(observation);
  std::vector<int>& seen_from = points_.at(observation.point).keyframes;
  seen_from.insert(std::upper_bound(seen_from.begin(), seen_from.end(), keyframe.id), keyframe.id);
}

void Map::remove_observation(int keyframe, int point) {
  MapPoint* p = this->point(point);
  if (p == nullptr) return;
  std::erase(p->keyframes, keyframe);
  std::erase_if(this->keyframe(keyframe).observations,
                [&](const Observation& seen) { return seen.point == point; });
  if (p->keyframes.size() < 2) remove_point(point);
}

void Map::remove_point(int point) {
  MapPoint* p = this->point(point);
  if (p == nullptr) return;
  for (const int id : p->keyframes) {
    std::erase_if(keyframe(id).observations,
                  [&](const Observation& seen) { return seen.point == point; });
  }
  points_.erase(point);
}

void Map::forget_images(int keep_newest) {
  const int first_kept = next_keyframe_ - keep_newest;
  if (first_kept <= first_with_image_) return;
  for (int id = first_with_image_; id < first_kept; ++id) {
    Keyframe& old = keyframe(id);
    old.pyramid = {};
    old.candidates.clear();
  }
  std::vector<int> gone;
  for (const auto& [id, point] : points_) {
    if (point.source_keyframe < first_kept) gone.push_back(id);
  }
  for (const int id : gone) remove_point(id);
  first_with_image_ = first_kept;
}

void Map::clear() { *this = Map(); }

MapPoint* Map::point(int id) {
  const auto found = points_.find(id);
  return found == points_.end() ? nullptr : &found->second;
}

const MapPoint* Map::point(int id) const {
  const auto found = points_.find(id);
  return found == points_.end() ? nullptr : &found->second;
}

std::vector<int> Map::covisible(int keyframe, int min_shared) const {
  std::map<int, int> shared;
  for (const Observation& seen : this->keyframe(keyframe).observations) {
    const MapPoint* p = point(seen.point);
    if (p == nullptr) continue;
    for (const int other : p->keyframes) {
      if (other != keyframe) ++shared[other];
    }
  }
  std::vector<std::pair<int, int>> ranked;
  for (const auto& [id, count] : shared) {
    if (count >= min_shared) ranked.emplace_back(count, id);
  }
  std::sort(ranked.rbegin(), ranked.rend());
  std::vector<int> ids;
  ids.reserve(ranked.size());
  for (const auto& [count, id] : ranked) ids.push_back(id);
  return ids;
}

}  // namespace overfly::odometry
