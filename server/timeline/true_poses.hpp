// The truth of a camera at the stamps of estimates, with which every error is computed. A fault of
// the camera's clock makes these stamps differ from the times of the frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/motion/pose.hpp"
#include "server/record/rows/rows.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// T_world_camera at a time: that of the frame with this time, otherwise interpolated between its
/// neighbours as in Trajectory::at. Empty before the first frame and after the last.
/// @param frames  of one camera, by time
[[nodiscard]] std::optional<Pose> true_pose_at(std::span<const FrameRow> frames, std::int64_t t_ns);

/// The frames that true_pose_at() needs for the times in [begin_ns, end_ns].
[[nodiscard]] std::vector<FrameRow> frames_around(const RunTimeline& timeline,
                                                  std::size_t camera,
                                                  std::int64_t begin_ns,
                                                  std::int64_t end_ns);

/// First and last time of the stamps of rows. @pre !rows.empty()
struct StampRange {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;
};
[[nodiscard]] StampRange stamps_of(const std::vector<EstimateRow>& rows);

}  // namespace overfly::server
