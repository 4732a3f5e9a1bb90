// The state of a run at an instant, and the neighbouring frames.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::net {

/// Alignments of the estimates, one for each estimator; empty if it has no such alignment.
struct EstimatePlaces {
  std::string mode = server::kRecordedAlignment;
  std::vector<std::optional<server::RowAlignment>> of_estimator;

  /// @pre check_alignment succeeds for this mode
  static EstimatePlaces of(const server::RunTimeline& timeline, const std::string& mode);
};

/// What the message `playback` says about a run: truth and estimates at an instant of the run,
/// interpolated between frames. Before the first frame `frame` is -1 and `truth` null.
[[nodiscard]] nlohmann::json instant_json(const server::RunTimeline& timeline,
                                          std::int64_t t_ns,
                                          const EstimatePlaces& places);

/// Stamp of the last recorded frame; 0 before the first.
[[nodiscard]] std::int64_t end_of(const server::RunTimeline& timeline);
/// Stamp of frame `frame`, or of the nearest recorded one before it (else the first). Empty if
/// nothing is recorded.
[[nodiscard]] std::optional<std::int64_t> time_of_frame(const server::RunTimeline& timeline,
                                                        std::int64_t frame);
/// Stamp of the frame `steps` recorded frames after (before, if negative) the one at t, clamped to
/// the recorded frames. Empty if nothing is recorded.
[[nodiscard]] std::optional<std::int64_t> time_of_step(const server::RunTimeline& timeline,
                                                       std::int64_t t_ns,
                                                       std::int64_t steps);

}  // namespace overfly::net
