#include "server/timeline/poses_at.hpp"

#include <algorithm>

#include "server/timeline/count_frames.hpp"

namespace overfly::server {
namespace {

double share(std::int64_t from_ns, std::int64_t to_ns, std::int64_t t_ns) {
  if (to_ns <= from_ns) return 0.0;
  return std::min(static_cast<double>(t_ns - from_ns) / static_cast<double>(to_ns - from_ns), 1.0);
}

/// Time between the first two frames [ns].
std::int64_t frame_period_ns(const RunTimeline& timeline) {
  const auto rows = timeline.frames(0, 2);
  return rows.size() < 2 ? 0 : rows[1].t_ns - rows[0].t_ns;
}

/// The estimator's row after `row`, if it is of the next frame and continues the same track.
std::optional<EstimateRow> continuation(const RunTimeline& timeline,
                                        std::size_t estimator,
                                        const EstimateRow& row) {
  const auto next = timeline.estimate_after(estimator, row.sample.t_ns);
  if (!next || next->sample.map_id != row.sample.map_id) return std::nullopt;
  // Stamps are rounded to 1 ns: two frames may be 1 ns further apart than the first two.
  const bool next_frame = next->sample.frame == row.sample.frame + 1 ||
                          next->sample.t_ns - row.sample.t_ns <= frame_period_ns(timeline) + 1;
  return next_frame ? next : std::nullopt;
}

}  // namespace

Pose truth_at(const RunTimeline& timeline, const FrameRow& row, std::int64_t t_ns) {
  if (row.t_ns == t_ns) return row.T_world_body;
  const std::size_t rows_to_t = count_frames(
      timeline, kMainCamera, [&](const FrameRow& other) { return other.t_ns <= t_ns; });
  const auto next = timeline.frames(rows_to_t, 1);
  if (next.empty()) return row.T_world_body;
  const double alpha = share(row.t_ns, next.front().t_ns, t_ns);
  return interpolate(row.T_world_body, next.front().T_world_body, alpha);
}

EstimateAt estimate_at(const RunTimeline& timeline,
                       std::size_t estimator,
                       const std::optional<RowAlignment>& alignment,
                       std::int64_t t_ns) {
  const auto row = timeline.estimate_at(estimator, t_ns);
  if (!row) return {};
  EstimateAt found{row->sample.state, alignment ? alignment->T_world_body(*row) : std::nullopt};
  if (!found.T_world_body || row->sample.t_ns == t_ns) return found;
  const auto next = continuation(timeline, estimator, *row);
  const auto T_world_body_next = next ? alignment->T_world_body(*next) : std::nullopt;
  if (T_world_body_next) {
    const double alpha = share(row->sample.t_ns, next->sample.t_ns, t_ns);
    found.T_world_body = interpolate(*found.T_world_body, *T_world_body_next, alpha);
  }
  return found;
}

}  // namespace overfly::server
