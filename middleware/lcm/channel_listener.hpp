// Listens to an LCM channel and passes its messages on as bytes. Does not require LCM.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/result.hpp"

namespace overfly::lcm {

/// @param url   "udpm://..." or "memq://"
/// @param take  called on a thread of the listener until that is destroyed
/// @param cancel  ends the test of the network; may be null
/// @return the listener
/// Errors: kUnsupported if LCM is not built in; kInvalidArgument naming the part of the URL; kIo
/// with a remedy if LCM cannot be opened; kCancelled.
[[nodiscard]] Result<std::shared_ptr<void>> listen_to_channel(
    const std::string& url,
    const std::string& channel,
    std::function<void(std::span<const std::uint8_t>)> take,
    const std::atomic<bool>* cancel);

}  // namespace overfly::lcm
