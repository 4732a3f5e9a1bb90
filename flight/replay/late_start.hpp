// A flight from a later instant on.
#pragma once

#include <cstdint>
#include <memory>

#include "core/motion/truth_source.hpp"
#include "core/result.hpp"

namespace overfly::flight {

/// The same flight with its clock set so that t = 0 is `start_ns` after its beginning. The mode and
/// the mission item that are in force then come at 0; other events before it are left out.
/// @param flight    without sensors of its own and not live
/// @param start_ns  at least 0
/// Errors: kInvalidArgument if the flight ends before that instant.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> started_late(std::unique_ptr<TruthSource> flight,
                                                                std::int64_t start_ns);

}  // namespace overfly::flight
