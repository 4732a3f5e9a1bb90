// Where an estimate's rows lie in the world under each alignment that the run was scored with.
#pragma once

#include <optional>
#include <string>

#include "core/pose.hpp"
#include "core/result.hpp"
#include "server/record/run_timeline.hpp"

namespace overfly::engine {

/// The alignment that every row carries from the start, scored or not.
inline constexpr const char* kRecordedAlignment = "init_scale";

/// Immutable.
class RowAlignment {
 public:
  /// The rows as recorded: `init_scale`, each map from its own first tracked frame.
  RowAlignment() = default;

  /// The similarity of `mode` from the run's metrics. It belongs to the map that was scored.
  /// Errors: kInvalidArgument for a mode that does not exist; kConflict while the run is not
  /// scored, when its metrics do not say the transform, or why this estimate has no such alignment.
  [[nodiscard]] static Result<RowAlignment> of(const RunTimeline& timeline,
                                               std::size_t estimator,
                                               const std::string& mode);

  /// Empty while not tracking, and for rows of another map than the one that was scored.
  [[nodiscard]] std::optional<Pose> T_world_body(const EstimateRow& row) const;

 private:
  struct Scored {
    Similarity S_world_vo;
    Pose T_camera_body;
    int map_id = 0;
  };
  std::optional<Scored> scored_;
};

/// Whether the alignment can be shown for this run: of one estimator at least.
/// Errors: as RowAlignment::of, when it is of none.
[[nodiscard]] Status check_alignment(const RunTimeline& timeline, const std::string& mode);

}  // namespace overfly::engine
