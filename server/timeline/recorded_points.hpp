// Map points of a run that were recorded with its debug images.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "server/record/recorded_numbers.hpp"
#include "server/record/rows/rows.hpp"
#include "server/timeline/row_alignment.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// The map points that an estimator observed last at or before a frame, world frame; empty if there
/// are none that can be read, and while it does not track.
[[nodiscard]] std::vector<Eigen::Vector3f> recorded_points(const std::filesystem::path& run_folder,
                                                           RecordedNumbers& numbers,
                                                           const RunTimeline& timeline,
                                                           std::size_t estimator,
                                                           const RowAlignment& alignment,
                                                           const FrameRow& row);

}  // namespace overfly::server
