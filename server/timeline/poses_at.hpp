// Poses of a run at an instant, also between two frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/motion/estimate.hpp"
#include "core/motion/pose.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// The true T_world_body at an instant, interpolated between the main camera's frames; that of the
/// last frame after it.
/// @param row  timeline.frame_at(t_ns)
[[nodiscard]] Pose truth_at(const RunTimeline& timeline, const FrameRow& row, std::int64_t t_ns);

struct EstimateAt {
  TrackingState state = TrackingState::kInitialising;
  std::optional<Pose> T_world_body;  ///< empty while not tracking, or without such an alignment
};

/// An estimator at an instant, its pose interpolated where its track goes on in the next frame.
/// @param alignment  of the estimator
[[nodiscard]] EstimateAt estimate_at(const RunTimeline& timeline,
                                     std::size_t estimator,
                                     const std::optional<RowAlignment>& alignment,
                                     std::int64_t t_ns);

}  // namespace overfly::server
