// Progress and cancellation of building a world's cache.
#pragma once

#include <functional>
#include <string>

namespace overfly::terrain {

/// Called from time to time with the share done in [0, 1]; returning false cancels.
using BuildProgress = std::function<bool(double share, const std::string& doing)>;

}  // namespace overfly::terrain
