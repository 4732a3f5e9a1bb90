// A trajectory that clients of a server may read: of a file, a flight log or a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/motion/pose.hpp"
#include "core/motion/trajectory_io.hpp"
#include "core/result.hpp"

namespace overfly::server {

/// Limits of one trajectory that a server reads: 500 000 poses are 41 minutes at 200 Hz.
inline constexpr TrajectoryLimits kServedTrajectoryLimits{std::uint64_t{64} << 20U, 500'000};

/// How the estimator of a run ended, as its metrics.json has it.
struct RunOutcome {
  std::string outcome;
  std::optional<double> outcome_time_s;
  double coverage = 0.0;
};

struct ServedTrajectory {
  TrajectoryFile file;
  std::string kind;  ///< "file", "log" or "run"
  /// Where the frame whose poses these are is mounted; used for roll, pitch and yaw. Files: the
  /// nadir camera, as evaluation::Options. Logs: identity. Runs: their camera.
  Pose T_body_pose{R_body_camera_nadir(), Eigen::Vector3d::Zero()};
  std::optional<RunOutcome> outcome;  ///< of a run's estimates, if it is scored
};

/// What a client calls a trajectory: "file:NAME", "log:NAME", "log:NAME?SOURCE", "run:ID/truth",
/// "run:ID/cameras/CAMERA" or "run:ID/ESTIMATOR".
struct TrajectoryReference {
  enum class Kind { kFile, kLog, kRun } kind = Kind::kFile;
  std::string name;  ///< of the file or the log, or the run's id
  std::string part;  ///< source of the log, or what follows the run's id
};

/// Errors: kNotFound for all other texts.
[[nodiscard]] Result<TrajectoryReference> trajectory_reference_from(const std::string& text);
/// The error for a name that no trajectory has, the same for every name.
[[nodiscard]] Error no_such_trajectory(const std::string& name);

}  // namespace overfly::server
