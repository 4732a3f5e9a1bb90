// Map points of a run that were recorded with its debug images.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "server/record/rows/rows.hpp"
#include "server/record/run_folder.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// The last frame up to the given one for which a folder holds a file.
using LastRecorded =
    std::function<std::optional<std::int64_t>(const std::filesystem::path&, std::int64_t)>;

/// The map points that an estimator observed last at or before a frame, world frame; empty if there
/// are none that can be read, and while it does not track.
/// @param last  a caller that asks often may remember what the folder holds
[[nodiscard]] std::vector<Eigen::Vector3f> recorded_points(const std::filesystem::path& run_folder,
                                                           const RunTimeline& timeline,
                                                           std::size_t estimator,
                                                           const RowAlignment& alignment,
                                                           const FrameRow& row,
                                                           const LastRecorded& last =
                                                               last_recorded_frame);

}  // namespace overfly::server
