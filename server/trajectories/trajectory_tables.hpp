// Poses and errors over time as columns of JSON, with their extremes.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

#include "evaluation/evaluation.hpp"
#include "server/scoring/file_score.hpp"
#include "server/trajectories/served_trajectory.hpp"

namespace overfly::server {

/// {"positions", "attitudes"}; at most `points` rows each.
[[nodiscard]] nlohmann::json pose_tables(const ServedTrajectory& trajectory, std::size_t points);

/// {"positions", "attitudes", "axis_errors", "errors", "scale"} of the aligned estimate at the
/// times of its matches; at most `points` rows each.
/// @param T_body_pose  as ServedTrajectory, of the estimate
/// @pre the score has the alignment
[[nodiscard]] nlohmann::json error_tables(const FileScore& score,
                                          evaluation::AlignmentMode mode,
                                          const Pose& T_body_pose,
                                          std::size_t points);

}  // namespace overfly::server
