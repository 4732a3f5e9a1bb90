// The cameras' part of metrics.json.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "server/record/run_records.hpp"

namespace overfly::engine {

/// [[first, last], ...] of ascending frame numbers.
[[nodiscard]] nlohmann::json ranges_of(const std::vector<std::int64_t>& frames);

/// `texture`: texels per pixel over the run; marked as limited if the median is below 0.5.
[[nodiscard]] nlohmann::json texture_json(const std::vector<FrameRecord>& frames);
/// `camera`: the main camera.
[[nodiscard]] nlohmann::json camera_metrics(const RunRecords& records);
/// `cameras`: {"NAME": ...} of all other cameras.
[[nodiscard]] nlohmann::json other_cameras_metrics(const RunRecords& records);

}  // namespace overfly::engine
