// The rows of a run folder's line files, as JSON.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/camera.hpp"
#include "core/result.hpp"
#include "server/engine/run_timeline.hpp"

namespace overfly::engine {

/// One line of frames.jsonl.
struct FrameRecord {
  FrameRow row;
  std::optional<double> axis_depth_m;  ///< of the ground along the optical axis
  /// The camera shakes on its mount: the body's pose is not that of the camera at rest.
  bool shaken = false;
};

/// One line of estimates/NAME.jsonl: an answer, or a frame that a busy estimator never got.
struct EstimateRecord {
  EstimateSample sample;
  std::map<std::string, double> counters;
  bool dropped = false;
  std::string crash;  ///< why the estimator is gone, at the frame where it went; else empty
  /// Of the image as it arrived where the estimator runs, as far as that place tells.
  std::optional<std::uint32_t> image_crc32;
};

/// {"p_m": [x, y, z], "q_xyzw": [x, y, z, w]}
[[nodiscard]] nlohmann::json json_from(const Pose& T);
[[nodiscard]] nlohmann::json json_from(const PinholeCamera& camera);
/// With `distortion` {"model", "coefficients"}.
[[nodiscard]] nlohmann::json json_from(const CameraModel& camera);
[[nodiscard]] nlohmann::json json_from(const FrameRecord& record);
[[nodiscard]] nlohmann::json json_from(const EstimateRecord& record);
[[nodiscard]] nlohmann::json json_from(const LogRow& row);

// The way back. Errors: kUnreadable naming the field.
[[nodiscard]] Result<Pose> pose_from(const nlohmann::json& value);
[[nodiscard]] Result<PinholeCamera> camera_from(const nlohmann::json& value);
/// Without a distortion where none is named.
[[nodiscard]] Result<CameraModel> camera_model_from(const nlohmann::json& value);
/// `T_body_camera` gives the row its pose of the body.
[[nodiscard]] Result<FrameRecord> frame_record_from(const nlohmann::json& value,
                                                    const Pose& T_body_camera);
[[nodiscard]] Result<EstimateRecord> estimate_record_from(const nlohmann::json& value);
[[nodiscard]] Result<LogRow> log_row_from(const nlohmann::json& value);

}  // namespace overfly::engine
