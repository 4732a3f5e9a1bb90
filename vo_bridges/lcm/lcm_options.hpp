// Options of the LCM door.
#pragma once

#include <atomic>
#include <string>

#include "vo_bridges/parameter.hpp"

namespace overfly {

struct LcmEstimatorOptions {
  /// "udpm://239.255.76.67:7667?ttl=0", "memq://" (within one process, for tests), or
  /// "file:///PATH?mode=w" (records the published messages and never answers; not in lockstep). For
  /// udpm, recv_buf_size defaults to at least 2 MiB.
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  /// Prefix of the channels IMAGE, CALIBRATION, TIME, POSE, STATUS, DEBUG: letters, digits, "_",
  /// "-", "/"; at most 40 characters. Each estimator of a process needs its own prefix on a
  /// network.
  std::string channel_prefix = "OVERFLY_";
  /// True: a lost image is sent again, and the first image waits until the estimator has started.
  bool lockstep = true;
  double start_timeout_s = 30.0;  ///< until the estimator answers its first frame
  /// Time limit for a frame's answer, in real time and in lockstep; after it the frame counts as
  /// unanswered.
  double answer_timeout_s = 5.0;
  VoParameters parameters;  ///< sent to the estimator with the calibration
  /// Set to true to cancel: every wait ends with kCancelled within 50 ms, the wait for an answer
  /// within a second. Null = not cancellable.
  const std::atomic<bool>* cancel = nullptr;
};

}  // namespace overfly
