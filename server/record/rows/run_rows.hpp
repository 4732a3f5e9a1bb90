// The rows of a run folder's line files, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "core/camera/camera_model.hpp"
#include "core/result.hpp"
#include "server/record/rows/rows.hpp"

namespace overfly::server {

/// {"p_m": [x, y, z], "q_xyzw": [x, y, z, w]}
[[nodiscard]] nlohmann::json json_from(const Pose& T);
[[nodiscard]] nlohmann::json json_from(const PinholeCamera& camera);
/// With `distortion` {"model", "coefficients"}.
[[nodiscard]] nlohmann::json json_from(const CameraModel& camera);
[[nodiscard]] nlohmann::json json_from(const FrameRow& row);
[[nodiscard]] nlohmann::json json_from(const EstimateRecord& record);
[[nodiscard]] nlohmann::json json_from(const LogRow& row);

// The inverse. Errors: kUnreadable naming the field.
[[nodiscard]] Result<Pose> pose_from(const nlohmann::json& value);
/// Without distortion if none is given.
[[nodiscard]] Result<CameraModel> camera_model_from(const nlohmann::json& value);
/// `T_body_camera` is used to compute the row's body pose.
[[nodiscard]] Result<FrameRow> frame_row_from(const nlohmann::json& value,
                                              const Pose& T_body_camera);
[[nodiscard]] Result<EstimateRecord> estimate_record_from(const nlohmann::json& value);
[[nodiscard]] Result<LogRow> log_row_from(const nlohmann::json& value);

}  // namespace overfly::server
