// Poses of an estimate's rows in the world under each alignment used for scoring.
#pragma once

#include <optional>
#include <string>

#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// The alignment that every row contains from the start, scored or not.
inline constexpr const char* kRecordedAlignment = "init_scale";

/// Immutable.
class RowAlignment {
 public:
  /// The rows as recorded: `init_scale`, each map aligned at its own first tracked frame.
  RowAlignment() = default;

  /// The similarity of `mode` from the run's metrics. It applies to the map that was scored.
  /// Errors: kInvalidArgument for an unknown mode; kConflict while the run is not scored, if its
  /// metrics do not contain the transform, or with the reason why this estimate has no such
  /// alignment.
  [[nodiscard]] static Result<RowAlignment> of(const RunTimeline& timeline,
                                               std::size_t estimator,
                                               const std::string& mode);

  /// Empty while not tracking, and for rows of a map that was not scored.
  [[nodiscard]] std::optional<Pose> T_world_body(const EstimateRow& row) const;
  /// The scale of T_world_body. @pre T_world_body(row) is not empty
  [[nodiscard]] double scale(const EstimateRow& row) const;
  /// The similarity of a map; empty if the map was not scored.
  /// @param recorded  that of `init_scale`, which each map has by itself
  [[nodiscard]] std::optional<Similarity> S_world_vo(int map_id, const Similarity& recorded) const;

 private:
  struct Scored {
    Similarity S_world_vo;
    Pose T_camera_body;
    int map_id = 0;
  };
  std::optional<Scored> scored_;
};

/// The camera whose images an estimator gets.
[[nodiscard]] std::size_t camera_of_estimator(const RunTimeline& timeline, std::size_t estimator);

/// Checks that the alignment can be shown for at least one estimator of this run.
/// Errors: as RowAlignment::of, if there is none.
[[nodiscard]] Status check_alignment(const RunTimeline& timeline, const std::string& mode);

}  // namespace overfly::server
