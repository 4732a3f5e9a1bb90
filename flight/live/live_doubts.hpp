// What a live flight reports of samples that look wrong. Private to live.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "flight/live/live_samples.hpp"

namespace overfly::flight::live {

/// A sentence for each kind of doubt there is.
/// @param start_ns  of the vehicle's clock: the flight's time 0
[[nodiscard]] std::vector<std::string> texts_of(const LiveDoubts& doubts, std::int64_t start_ns);

}  // namespace overfly::flight::live
