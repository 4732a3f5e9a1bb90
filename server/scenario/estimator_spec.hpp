// What a scenario, or a command line, asks of one estimator.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vo_bridges/parameter.hpp"
#include "vo_bridges/ros1/ros1_estimator.hpp"

namespace overfly::engine {

struct EstimatorSpec {
  std::string name;  ///< unique in the scenario; names the files
  /// "feature", "perfect", "drifting", "process", "lcm", "ros1"
  std::string type;
  std::size_t camera = 0;   ///< index of the camera whose images it gets
  VoParameters parameters;  ///< native ones take them, others are told them

  // Of a process: the child's program and arguments, or where somebody else's connects, or both.
  std::vector<std::string> command;
  std::string listen;            ///< "unix:PATH" or "tcp:HOST:PORT"; empty = the child's own socket
  double memory_limit_mb = 0.0;  ///< of the child's address space; 0 = none

  /// It may run on: the child, or the native estimator's thread with all that it starts; empty =
  /// all.
  std::vector<int> cpus;
  /// In real time it takes at most so many frames a second, as if each took it 1 / throttle_hz;
  /// 0 = as fast as it can.
  double throttle_hz = 0.0;

  // Of process, lcm and ros1; empty = as the door's options say.
  std::optional<double> start_timeout_s;
  std::optional<double> answer_timeout_s;

  // Of lcm; empty = as the door's options say.
  std::string lcm_url;
  std::string lcm_channel_prefix;

  Ros1EstimatorOptions ros1;  ///< topics and frames; what is said above goes before its own
};

/// True for the types whose estimator runs in a process of its own.
[[nodiscard]] bool is_outside_estimator(const std::string& type);
/// True for the types that are given the truth.
[[nodiscard]] bool is_test_estimator(const std::string& type);

}  // namespace overfly::engine
