#include "server/net/stream/run_instant.hpp"

#include <algorithm>

#include "server/net/stream/row_encoder.hpp"
#include "server/timeline/count_frames.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;
using server::EstimateRow;
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

double share(std::int64_t from_ns, std::int64_t to_ns, std::int64_t t_ns) {
  if (to_ns <= from_ns) return 0.0;
  return static_cast<double>(t_ns - from_ns) / static_cast<double>(to_ns - from_ns);
}

json truth_json(const RunTimeline& timeline, const FrameRow& row, std::int64_t t_ns) {
  const std::int64_t rows_to_t =
      main_frames_where(timeline, [&](const FrameRow& other) { return other.t_ns <= t_ns; });
  const auto next = timeline.frames(static_cast<std::size_t>(rows_to_t), 1);
  if (next.empty() || row.t_ns == t_ns) return pose_json(row.T_world_body);
  const double alpha = share(row.t_ns, next.front().t_ns, t_ns);
  return pose_json(interpolate(row.T_world_body, next.front().T_world_body, alpha));
}

/// The estimator's row after `row`, if it continues the same track.
std::optional<EstimateRow> continuation(const RunTimeline& timeline,
                                        std::size_t estimator,
                                        const EstimateRow& row,
                                        std::int64_t frame_period_ns) {
  const auto next = timeline.estimate_at(estimator, row.sample.t_ns + frame_period_ns);
  const bool same_track =
      next && next->sample.t_ns > row.sample.t_ns && next->sample.map_id == row.sample.map_id;
  return same_track ? next : std::nullopt;
}

json estimate_json(const RunTimeline& timeline,
                   std::size_t estimator,
                   const EstimatePlaces& places,
                   std::int64_t t_ns,
                   std::int64_t frame_period_ns) {
  const auto row = timeline.estimate_at(estimator, t_ns);
  if (!row) return {{"state", to_string(TrackingState::kInitialising)}, {"pose", nullptr}};
  json pose = nullptr;
  const auto& place = places.of_estimator.at(estimator);
  if (auto T_world_body = place ? place->T_world_body(*row) : std::nullopt) {
    const auto next = continuation(timeline, estimator, *row, frame_period_ns);
    const auto T_world_body_next = next ? place->T_world_body(*next) : std::nullopt;
    if (T_world_body_next) {
      const double alpha = share(row->sample.t_ns, next->sample.t_ns, t_ns);
      T_world_body = interpolate(*T_world_body, *T_world_body_next, std::min(alpha, 1.0));
    }
    pose = pose_json(*T_world_body);
  }
  return {{"state", to_string(row->sample.state)}, {"pose", std::move(pose)}};
}

/// Time between the first two frames [ns].
std::int64_t frame_period_ns(const RunTimeline& timeline) {
  const auto rows = timeline.frames(0, 2);
  return rows.size() < 2 ? 0 : rows[1].t_ns - rows[0].t_ns;
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
  const std::int64_t period_ns = frame_period_ns(timeline);
  for (std::size_t i = 0; i < timeline.estimators().size(); ++i) {
    estimates[timeline.estimators()[i]] = estimate_json(timeline, i, places, t_ns, period_ns);
  }
  return {{"t_ns", t_ns},
          {"frame", row ? row->frame : -1},
          {"alignment", places.mode},
          {"truth", row ? truth_json(timeline, *row, t_ns) : json(nullptr)},
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
