#include "server/net/stream/run_instant.hpp"

#include <algorithm>

#include "server/net/stream/row_encoder.hpp"
#include "server/timeline/count_frames.hpp"
#include "server/timeline/poses_at.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::FrameRow;
using server::RunTimeline;

/// Number of the main camera's frames for which `before` holds. @pre as server::count_frames
template <typename Before>
std::int64_t main_frames_where(const RunTimeline& timeline, const Before& before) {
  return static_cast<std::int64_t>(server::count_frames(timeline, server::kMainCamera, before));
}

std::optional<std::int64_t> time_of_row(const RunTimeline& timeline, std::int64_t index) {
  const auto count = static_cast<std::int64_t>(timeline.frame_count());
  if (count == 0) return std::nullopt;
  const std::int64_t nearest = std::clamp<std::int64_t>(index, 0, count - 1);
  return timeline.frames(static_cast<std::size_t>(nearest), 1).front().t_ns;
}

json estimate_json(const server::EstimateAt& estimate) {
  json pose = estimate.T_world_body ? pose_json(*estimate.T_world_body) : json(nullptr);
  return {{"state", to_string(estimate.state)}, {"pose", std::move(pose)}};
}

}  // namespace

EstimatePlaces EstimatePlaces::of(const RunTimeline& timeline, const std::string& mode) {
  EstimatePlaces places;
  places.mode = mode;
  for (std::size_t i = 0; i < timeline.estimators().size(); ++i) {
    const auto place = server::RowAlignment::of(timeline, i, mode);
    places.of_estimator.push_back(place ? std::optional(*place) : std::nullopt);
  }
  return places;
}

json instant_json(const RunTimeline& timeline, std::int64_t t_ns, const EstimatePlaces& places) {
  const auto row = timeline.frame_at(t_ns);
  json estimates = json::object();
  for (std::size_t i = 0; i < timeline.estimators().size(); ++i) {
    estimates[timeline.estimators()[i]] =
        estimate_json(server::estimate_at(timeline, i, places.of_estimator.at(i), t_ns));
  }
  return {{"t_ns", t_ns},
          {"frame", row ? row->frame : -1},
          {"alignment", places.mode},
          {"truth", row ? pose_json(server::truth_at(timeline, *row, t_ns)) : json(nullptr)},
          {"estimates", std::move(estimates)}};
}

std::int64_t end_of(const RunTimeline& timeline) {
  const std::size_t count = timeline.frame_count();
  return count == 0 ? 0 : timeline.frames(count - 1, 1).front().t_ns;
}

std::optional<std::int64_t> time_of_frame(const RunTimeline& timeline, std::int64_t frame) {
  const std::int64_t rows_to_frame =
      main_frames_where(timeline, [&](const FrameRow& row) { return row.frame <= frame; });
  return time_of_row(timeline, rows_to_frame - 1);
}

std::optional<std::int64_t> time_of_step(const RunTimeline& timeline,
                                         std::int64_t t_ns,
                                         std::int64_t steps) {
  const std::int64_t rows_to_t =
      main_frames_where(timeline, [&](const FrameRow& row) { return row.t_ns <= t_ns; });
  return time_of_row(timeline, rows_to_t - 1 + steps);
}

}  // namespace overfly::net
