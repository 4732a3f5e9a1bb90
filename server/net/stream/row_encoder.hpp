// A run's rows as JSON columns, and its description as the RUN object (docs/PROTOCOL.md).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/pose.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::net {

/// {"x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"}, rounded to millimetres and 1e-4 deg
/// to keep the text short.
[[nodiscard]] nlohmann::json pose_json(const Pose& T_world_body);

/// The column of an estimator's counter.
[[nodiscard]] std::string counter_column(const std::string& counter);

/// Columns of the stream `truth`, of `estimate/NAME`, and of `log`.
[[nodiscard]] nlohmann::json truth_columns(const std::vector<server::FrameRow>& rows);
/// Poses and errors of the estimates by `alignment`, by default as recorded, and a column
/// `counter.NAME` for each of the estimator's counters so far.
[[nodiscard]] nlohmann::json estimate_columns(const server::RunTimeline& timeline,
                                              std::size_t estimator,
                                              const std::vector<server::EstimateRow>& rows,
                                              const server::RowAlignment& alignment = {});
[[nodiscard]] nlohmann::json log_columns(const std::vector<server::LogRow>& rows);
[[nodiscard]] nlohmann::json vehicle_columns(const std::vector<VehicleStatus>& rows);

/// {"NAME": status, ...} of a run's estimators, as in the message `estimators`.
[[nodiscard]] nlohmann::json estimator_statuses_json(const server::RunTimeline& timeline);

[[nodiscard]] nlohmann::json run_json(const server::RunInfo& info);
/// With `results`, `tags` and `note`, which are read from the folder of a run that has ended.
[[nodiscard]] nlohmann::json listed_run_json(const server::RunInfo& info);

}  // namespace overfly::net
