#pragma once

#include <cstddef>

#include "core/result.hpp"
#include "server/dataset/dataset.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::engine {

/// Opens a data set and checks all but the images' content: every file is there. Images that are
/// not in order of time are sorted, and of those with the same time the first is kept; `warnings`
/// counts them.
/// Errors: kInvalidArgument for options, a missing calibration or a folder of no known layout;
/// kNotFound; kUnreadable naming file, line and value.
[[nodiscard]] Result<Dataset> open_dataset(const DatasetOptions& options);

/// Reads image `i` as an estimator is to get it: 8-bit grey, with its CRC-32.
/// Errors: kNotFound, kUnreadable naming the image and where it is listed: not an image, damaged,
/// or of another size than the calibration's.
[[nodiscard]] Result<VoFrame> read_frame(const Dataset& dataset, std::size_t i);

}  // namespace overfly::engine
