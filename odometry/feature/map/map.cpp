#include "odometry/feature/map/map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace overfly::odometry::feature {
namespace {

/// Patches whose positions differ by less, at the finer patch's level, belong to the same corner.
constexpr double kSameCornerPx = 1.5;

}  // namespace

Keyframe& Map::add_keyframe(Keyframe keyframe) {
  keyframe.id = next_keyframe_++;
  const int id = keyframe.id;
  return keyframes_.emplace(id, std::move(keyframe)).first->second;
}

MapPoint& Map::add_point(MapPoint point) {
  point.id = next_point_++;
  return points_.add(std::move(point));
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
  for (auto i = keyframes_.begin(); i->first < first_kept; ++i) {
    i->second.pyramid = {};
    i->second.candidates.clear();
  }
  std::vector<int> gone;
  for (const MapPoint& point : points_) {
    if (point.source_keyframe < first_kept) gone.push_back(point.id);
  }
  for (const int id : gone) remove_point(id);
  points_.trim();
  std::erase_if(keyframes_, [first_kept](const auto& entry) {
    return entry.first < first_kept && entry.second.observations.empty();
  });
  first_with_image_ = first_kept;
}

Map Map::newest_part(int keyframes) const {
  Map part;
  part.next_keyframe_ = next_keyframe_;
  part.next_point_ = next_point_;
  const int first = std::max(first_with_image_, next_keyframe_ - keyframes);
  part.first_with_image_ = first;
  for (auto i = keyframes_.lower_bound(first); i != keyframes_.end(); ++i) {
    const Keyframe& whole = i->second;
    Keyframe& copy = part.keyframes_[i->first];
    copy.id = whole.id;
    copy.frame = whole.frame;
    copy.t_ns = whole.t_ns;
    copy.T_camera_vo = whole.T_camera_vo;
    copy.pyramid = whole.pyramid;
    copy.plane = whole.plane;
    if (std::next(i) == keyframes_.end()) copy.observations = whole.observations;
  }
  for (const MapPoint& point : points_) {
    if (point.source_keyframe >= first) part.points_.add(point);
  }
  return part;
}

std::size_t Map::memory_bytes() const {
  std::size_t bytes = image_bytes();
  for (const auto& [id, keyframe] : keyframes_) {
    bytes += sizeof(Keyframe) + keyframe.observations.capacity() * sizeof(Observation) +
             keyframe.candidates.capacity() * sizeof(Candidate);
  }
  for (const MapPoint& point : points_) {
    bytes += sizeof(MapPoint) + point.keyframes.capacity() * sizeof(int);
  }
  return bytes;
}

std::size_t Map::image_bytes() const {
  std::size_t bytes = 0;
  for (const auto& [id, keyframe] : keyframes_) {
    for (const cv::Mat& level : keyframe.pyramid.levels) bytes += level.total();
  }
  return bytes;
}

const MapPoint* point_at(const Map& map,
                         const Keyframe& keyframe,
                         const Eigen::Vector2d& pixel,
                         int patch_level) {
  for (const Observation& seen : keyframe.observations) {
    const MapPoint* point = map.point(seen.point);
    if (point == nullptr) continue;
    const double radius_px = std::ldexp(kSameCornerPx, std::min(patch_level, point->patch_level));
    if ((seen.pixel - pixel).squaredNorm() < radius_px * radius_px) return point;
  }
  return nullptr;
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

}  // namespace overfly::odometry::feature
