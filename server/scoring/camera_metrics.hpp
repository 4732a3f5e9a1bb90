// The cameras' part of a run's metrics.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/record/run_records.hpp"
#include "server/scoring/run_metrics.hpp"

namespace overfly::server {

/// The runs of consecutive numbers among ascending frame numbers.
[[nodiscard]] std::vector<FrameRange> ranges_of(const std::vector<std::int64_t>& frames);

[[nodiscard]] CameraMetrics camera_metrics_from(const CameraRecords& camera);

/// "in 34 % of the frames more than half of the image of the camera is without imagery" if more
/// than a tenth of the frames are, else empty.
/// @param name  of the camera, for people
[[nodiscard]] std::string void_words(const std::string& name, const CameraMetrics& camera);

}  // namespace overfly::server
