// An estimator that is connected by LCM channels (README.md in this folder).
#pragma once

#include <memory>

#include "core/result.hpp"
#include "vo_bridges/lcm/lcm_options.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// Connects to an estimator over LCM.
/// Errors: kUnsupported if LCM is not built in; kInvalidArgument naming the option, its value and
/// limit; kIo if LCM cannot be opened (for example without a multicast route); kConflict if another
/// estimator of this process uses the channels; kCancelled. `prepare` and `track` fail with
/// kInternal if no estimator responds in time, and `track` also after five consecutive frames
/// without any message.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_lcm_estimator(
    const LcmEstimatorOptions& options);

}  // namespace overfly
