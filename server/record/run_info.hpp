// The fields of a run that are shown in a list of runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "core/earth/geodesy.hpp"
#include "core/motion/pose.hpp"
#include "evaluation/evaluation.hpp"

namespace overfly::server {

enum class RunStatus {
  kQueued,
  kRunning,
  kCompleted,
  kFailed,
  kCancelled,
  kInterrupted,  ///< its program ended before the run did
  kUnreadable,   ///< its folder is invalid; RunInfo::problem gives the reason
};
[[nodiscard]] const char* to_string(RunStatus status);  ///< "queued", "running", ...

/// How one estimator performed.
struct EstimatorResult {
  std::string estimator;  ///< name
  evaluation::Outcome outcome = evaluation::Outcome::kNotInitialised;
  /// Of alignment init_scale; empty if the estimate could not be aligned.
  std::optional<double> position_rmse_m;
  std::optional<double> position_rmse_percent;  ///< of the path; likewise
};

/// The fields shown in a list of runs.
struct RunInfo {
  std::string id;        ///< folder name
  std::string scenario;  ///< name
  std::string title;
  RunStatus status = RunStatus::kQueued;
  std::string created_utc;       ///< ISO 8601
  std::string error;             ///< why it failed; else empty
  std::string problem;           ///< invalid file and field of its folder; else empty
  std::int64_t duration_ns = 0;  ///< of the flight, 0 = not known yet
  std::int64_t frames = 0;       ///< frames done
  std::int64_t frames_total = 0;
  std::string pacing;
  std::vector<std::string> estimators;
  std::vector<std::string> estimator_cameras;  ///< the camera whose images each estimator gets
  std::string flight;                          ///< what is flown, for people; empty = not known yet
  std::uint64_t seed = 0;
  std::string attribution;
  std::optional<Geodetic> origin;  ///< of the world frame; empty until the world is open
  /// Unix time of t = 0; empty until it is known, before the first frame.
  std::optional<std::int64_t> epoch_utc_ns;
  std::vector<std::string> cameras;  ///< names, the main camera first
  /// The imagery, not the camera, limits the result: the median is below 0.5 texels per pixel.
  bool texture_limited = false;
  std::vector<EstimatorResult> results;  ///< by name; empty until the run is scored
  std::vector<std::string> tags;         ///< written by people; see RunNotes
  std::string note;                      ///< likewise
  /// The step in progress before the first frame ("making the built-in world: 30 %"); else empty.
  /// Known to this process only; not stored in a file.
  std::string notice;
  /// Place in the queue of a waiting run, 1 = next; 0 = it does not wait. Known to this process
  /// only; not stored in a file.
  std::int64_t queue_position = 0;
  /// Time until a flying run ends [s]; empty if that is not known. Likewise.
  std::optional<double> left_s;
  /// Files of the world that have changed since the flight; empty if none has, and until the world
  /// was opened for a view. Known to this process only; not stored in a file.
  std::string world_change;
};

/// Index of a run's main camera, in every list of its cameras.
inline constexpr std::size_t kMainCamera = 0;

/// One camera of a run.
struct RunCamera {
  std::string name;
  CameraModel model;
  Pose T_body_camera{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
};

}  // namespace overfly::server
