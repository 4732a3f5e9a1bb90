// What a list of runs shows of each.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera_model.hpp"
#include "core/pose.hpp"

namespace overfly::engine {

enum class RunStatus {
  kQueued,
  kRunning,
  kCompleted,
  kFailed,
  kCancelled,
  kInterrupted,  ///< its program ended before it did
  kUnreadable,   ///< its folder does not say; RunInfo::problem tells why
};
[[nodiscard]] const char* to_string(RunStatus status);  ///< "queued", "running", ...

/// What a list of runs shows.
struct RunInfo {
  std::string id;        ///< folder name
  std::string scenario;  ///< name
  std::string title;
  RunStatus status = RunStatus::kQueued;
  std::string created_utc;       ///< ISO 8601
  std::string error;             ///< why it failed; empty otherwise
  std::string problem;           ///< file and field of its folder that are wrong; else empty
  std::int64_t duration_ns = 0;  ///< of the flight, 0 = not known yet
  std::int64_t frames = 0;       ///< done
  std::int64_t frames_total = 0;
  std::string pacing;
  std::vector<std::string> estimators;
  std::vector<std::string> estimator_cameras;  ///< whose images each estimator gets
  std::string attribution;
  std::vector<std::string> cameras;  ///< names, the main one first
  /// The imagery, not the camera, limits the result: fewer than 0.5 texels a pixel (median).
  bool texture_limited = false;
  /// What it is busy with before its first frame ("making the built-in world: 30 %"); empty
  /// otherwise. Of this process only: no file keeps it.
  std::string notice;
  /// Which files of its world have changed since it was flown; empty where none has, and until its
  /// world was opened for a view. Of this process only: no file keeps it.
  std::string world_change;
};

/// One camera of a run.
struct RunCamera {
  std::string name;
  CameraModel model;
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
};

}  // namespace overfly::engine
