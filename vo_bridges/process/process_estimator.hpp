// An estimator in a process of its own, spoken to over a socket (docs/VO_PROTOCOL.md).
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "vo_bridges/parameter.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

struct ProcessEstimatorOptions {
  /// Program and arguments of the child to start; empty = somebody else starts the estimator, and
  /// it connects to `listen`.
  std::vector<std::string> command;
  /// "unix:PATH" or "tcp:HOST:PORT"; empty = a Unix socket of its own for a child.
  std::string listen;
  std::filesystem::path working_folder;  ///< of the child; empty = ours
  VoParameters parameters;               ///< told to the estimator in our hello
  /// True: every frame is answered before the next one is sent. False: the estimator may be told to
  /// hurry; it still answers each frame it gets.
  bool lockstep = true;
  double rate_hz = 0.0;           ///< of the camera, told with its calibration; 0 = not known
  double start_timeout_s = 30.0;  ///< until it is ready, and again once it is calibrated; (0, 3600]
  double answer_timeout_s = 20.0;  ///< for one frame, in (0, 3600]
  std::vector<int> cpus;           ///< the child may run on; empty = all
  double memory_limit_mb = 0.0;    ///< of the child's address space [1e6 bytes]; 0 = none
  /// Where the child's stdout and stderr go, in full (up to 64 MB); empty = only to take_log().
  std::filesystem::path output_file;
  /// When it turns true, every wait ends with kCancelled: within 50 ms, that for an answer after a
  /// second. A child has its time to end by itself after STOP all the same. Null = nobody cancels.
  const std::atomic<bool>* cancel = nullptr;
};

/// Starts the child (or waits for the one that connects) and shakes hands.
/// Errors: kInvalidArgument naming the option; kNotFound for a program that is not there; kInternal
/// when it does not say hello in time, speaks another version, or dies, with its last lines;
/// kCancelled.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_process_estimator(
    const ProcessEstimatorOptions& options);

}  // namespace overfly
