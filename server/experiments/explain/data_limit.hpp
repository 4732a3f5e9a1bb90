// Whether the imagery, not the estimator, is the limit.
#pragma once

#include <string>
#include <vector>

#include "server/experiments/explain/explanation.hpp"

namespace overfly::server::experiments {

/// Why the imagery is the limit, as a sentence: synthetic detail helps; or nothing explains the
/// failure, and the ground has too little detail, or is missing. Empty if it is not.
/// @param control  the flight with nothing changed
[[nodiscard]] std::string data_limit(const Reflight& control,
                                     const std::vector<Cause>& necessary,
                                     const std::vector<Cause>& sufficient);

}  // namespace overfly::server::experiments
