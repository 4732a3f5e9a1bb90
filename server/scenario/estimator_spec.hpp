// One estimator, as a scenario or a command line describes it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vo_bridges/parameter.hpp"
#include "vo_bridges/ros1/ros1_options.hpp"

namespace overfly::server {

struct EstimatorSpec {
  std::string name;  ///< unique in the scenario; used in file names
  /// "feature", "baseline_...", "perfect", "drifting", "process", "lcm", "ros1"
  std::string type;
  std::size_t camera = 0;   ///< index of the camera whose images it gets
  VoParameters parameters;  ///< set in native estimators, sent to others

  // For a process: program and arguments of the child, the address where an external one connects,
  // or both.
  std::vector<std::string> command;
  std::string listen;  ///< "unix:PATH" or "tcp:HOST:PORT"; empty = the child's private socket
  double memory_limit_mb = 0.0;  ///< of the child's address space; 0 = none

  /// Processors it may run on: for the child, or for the native estimator's thread and its child
  /// threads; empty = all.
  std::vector<int> cpus;
  /// In real time the estimator takes at most this many frames a second, as if each took 1 /
  /// throttle_hz; 0 = no limit.
  double throttle_hz = 0.0;

  // For process, lcm and ros1; empty = default of the door.
  std::optional<double> start_timeout_s;
  std::optional<double> answer_timeout_s;

  // For lcm; empty = default of the door.
  std::string lcm_url;
  std::string lcm_channel_prefix;

  Ros1EstimatorOptions ros1;  ///< topics and frames; the fields above take precedence
};

/// True for types whose estimator runs in another process.
[[nodiscard]] bool is_outside_estimator(const std::string& type);
/// True for the types that an estimator has to beat (odometry/baseline/).
[[nodiscard]] bool is_baseline_estimator(const std::string& type);
/// True for types that get the truth.
[[nodiscard]] bool is_test_estimator(const std::string& type);

}  // namespace overfly::server
