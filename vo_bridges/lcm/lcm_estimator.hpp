// An estimator that is connected by LCM channels (vo_bridges/lcm/types).
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "vo_bridges/parameter.hpp"
#include "vo_bridges/vo_port.hpp"

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

/// True if this build supports LCM.
[[nodiscard]] bool lcm_is_built_in();

/// Connects to an estimator over LCM.
/// Errors: kUnsupported if LCM is not built in; kInvalidArgument naming the option, its value and
/// limit; kIo if LCM cannot be opened (for example without a multicast route); kConflict if another
/// estimator of this process uses the channels; kCancelled. `prepare` and `track` fail with
/// kInternal if no estimator responds in time, and `track` also after five consecutive frames
/// without any message.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_lcm_estimator(
    const LcmEstimatorOptions& options);

}  // namespace overfly
