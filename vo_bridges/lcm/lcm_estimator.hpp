// An estimator that listens and answers on LCM channels (vo_bridges/lcm/types).
#pragma once

#include <memory>
#include <string>

#include "core/result.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

struct LcmEstimatorOptions {
  /// As lcm_create's: "udpm://239.255.76.67:7667?ttl=0", "memq://", "file://...".
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  std::string channel_prefix = "OVERFLY_";  ///< of IMAGE, CALIBRATION, TIME, POSE, STATUS, DEBUG
  bool lockstep = true;                     ///< wait for the answer to each frame
  double start_timeout_s = 30.0;            ///< in lockstep: for the answer to the first frame
  double answer_timeout_s =
      5.0;  ///< in lockstep: for a frame's answer; then it counts as unanswered
};

/// True where this build speaks LCM.
[[nodiscard]] bool lcm_is_built_in();

/// Errors: kUnsupported where LCM is not built in; kInvalidArgument for a URL that LCM does not
/// take; kIo where it cannot be opened (no multicast route, say).
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_lcm_estimator(
    const LcmEstimatorOptions& options);

}  // namespace overfly
