// Options of the process door.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "vo_bridges/parameter.hpp"

namespace overfly {

struct ProcessEstimatorOptions {
  /// Program and arguments of the child to start; empty = the estimator is started by other means
  /// and connects to `listen`.
  std::vector<std::string> command;
  /// "unix:PATH" or "tcp:HOST:PORT"; empty = a private Unix socket for a child.
  std::string listen;
  std::filesystem::path working_folder;  ///< of the child; empty = that of this process
  VoParameters parameters;               ///< sent to the estimator in the hello
  /// True: every frame is answered before the next one is sent. False: the estimator may be asked
  /// to hurry; it still answers every frame it receives.
  bool lockstep = true;
  double rate_hz = 0.0;            ///< of the camera, sent with its calibration; 0 = unknown
  double start_timeout_s = 30.0;   ///< until it is ready, and again after calibration; (0, 3600]
  double answer_timeout_s = 20.0;  ///< for one frame, in (0, 3600]
  std::vector<int> cpus;           ///< CPUs for the child; empty = all
  double memory_limit_mb = 0.0;    ///< of the child's address space [1e6 bytes]; 0 = unlimited
  /// File for the child's complete stdout and stderr (up to 64 MB); empty = only take_log().
  std::filesystem::path output_file;
  /// Set to true to cancel: every wait ends with kCancelled within 50 ms, the wait for an answer
  /// within a second. A child still gets its time to end by itself after STOP. Null = not
  /// cancellable.
  const std::atomic<bool>* cancel = nullptr;
};

namespace process {

/// Errors: kInvalidArgument naming the first option outside its limits, its value and the limit.
[[nodiscard]] Status validate(const ProcessEstimatorOptions& options);

}  // namespace process
}  // namespace overfly
