#include "server/timeline/true_poses.hpp"

#include <algorithm>
#include <iterator>

#include "server/timeline/count_frames.hpp"

namespace overfly::server {

std::optional<Pose> true_pose_at(std::span<const FrameRow> frames, std::int64_t t_ns) {
  const auto after =
      std::lower_bound(frames.begin(), frames.end(), t_ns, [](const FrameRow& row, std::int64_t t) {
        return row.t_ns < t;
      });
  if (after == frames.end()) return std::nullopt;
  if (after->t_ns == t_ns) return after->T_world_camera;
  if (after == frames.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double alpha =
      static_cast<double>(t_ns - before->t_ns) / static_cast<double>(after->t_ns - before->t_ns);
  return interpolate(before->T_world_camera, after->T_world_camera, alpha);
}

std::vector<FrameRow> frames_around(const RunTimeline& timeline,
                                    std::size_t camera,
                                    std::int64_t begin_ns,
                                    std::int64_t end_ns) {
  const std::size_t past_begin =
      count_frames(timeline, camera, [&](const FrameRow& row) { return row.t_ns <= begin_ns; });
  const std::size_t begin = past_begin > 0 ? past_begin - 1 : 0;
  const std::size_t before_end =
      count_frames(timeline, camera, [&](const FrameRow& row) { return row.t_ns < end_ns; });
  // Fewer, if the truth does not reach end_ns.
  return timeline.frames(begin, std::max(before_end, begin) + 1 - begin, camera);
}

StampRange stamps_of(const std::vector<EstimateRow>& rows) {
  const auto [first, last] =
      std::minmax_element(rows.begin(), rows.end(), [](const EstimateRow& a, const EstimateRow& b) {
        return a.sample.t_ns < b.sample.t_ns;
      });
  return {first->sample.t_ns, last->sample.t_ns};
}

}  // namespace overfly::server
