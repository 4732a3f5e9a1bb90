// An estimator in its own process, connected by a socket (docs/VO_PROTOCOL.md).
#pragma once

#include <memory>

#include "core/result.hpp"
#include "vo_bridges/process/options.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// Starts the child (or waits for a connection) and performs the handshake.
/// Errors: kInvalidArgument naming the option; kNotFound if the program does not exist; kInternal
/// with the last lines of output if the estimator sends no hello in time, uses another protocol
/// version, or dies; kCancelled.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_process_estimator(
    const ProcessEstimatorOptions& options);

}  // namespace overfly
