// An estimator that listens and answers on LCM channels (vo_bridges/lcm/types).
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "vo_bridges/parameter.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

struct LcmEstimatorOptions {
  /// "udpm://239.255.76.67:7667?ttl=0", "memq://" (within one process: tests), or
  /// "file:///PATH?mode=w" (records what is published, and answers nothing: not in lockstep).
  /// Where udpm has no recv_buf_size, one of at least 2 MiB is asked for.
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  /// Of IMAGE, CALIBRATION, TIME, POSE, STATUS, DEBUG: letters, digits, "_", "-", "/";
  /// at most 40. No two estimators of a process have the same one on one network.
  std::string channel_prefix = "OVERFLY_";
  /// True: a lost image is sent again, and the first one waits for the estimator to start.
  bool lockstep = true;
  double start_timeout_s = 30.0;  ///< for the estimator to be there and answer its first frame
  /// For a frame's answer, in real time as in lockstep; then it counts as unanswered.
  double answer_timeout_s = 5.0;
  VoParameters parameters;  ///< told to the estimator with the calibration
  /// When it turns true, every wait ends with kCancelled: within 50 ms, that for an answer after a
  /// second. Null = nobody cancels.
  const std::atomic<bool>* cancel = nullptr;
};

/// True where this build speaks LCM.
[[nodiscard]] bool lcm_is_built_in();

/// Errors: kUnsupported where LCM is not built in; kInvalidArgument naming the option, its value
/// and limit; kIo where LCM cannot be opened (no multicast route, say); kConflict where another
/// estimator of this process has the channels; kCancelled. Its `prepare` and `track` fail with
/// kInternal when no estimator is there in time, and `track` when one has left five frames in a row
/// without a word.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_lcm_estimator(
    const LcmEstimatorOptions& options);

}  // namespace overfly
