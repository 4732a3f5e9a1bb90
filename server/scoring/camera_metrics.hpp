// What metrics.json says of the cameras.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "server/record/run_records.hpp"

namespace overfly::engine {

/// [[first, last], ...] of ascending frame numbers.
[[nodiscard]] nlohmann::json ranges_of(const std::vector<std::int64_t>& frames);

/// `texture`: texels per pixel over the run; limited where the median is below 0.5.
[[nodiscard]] nlohmann::json texture_json(const std::vector<FrameRecord>& frames);
/// `camera`: the main one.
[[nodiscard]] nlohmann::json camera_metrics(const RunRecords& records);
/// `cameras`: {"NAME": ...} of all others.
[[nodiscard]] nlohmann::json other_cameras_metrics(const RunRecords& records);

}  // namespace overfly::engine
