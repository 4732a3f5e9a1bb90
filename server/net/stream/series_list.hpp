// What a viewer can plot of a run: every numeric column of its data streams, with label and unit.
#pragma once

#include <nlohmann/json.hpp>

#include "server/timeline/run_timeline.hpp"

namespace overfly::net {

/// The list of the message `series` (docs/PROTOCOL.md).
[[nodiscard]] nlohmann::json series_json(const server::RunTimeline& timeline);

}  // namespace overfly::net
