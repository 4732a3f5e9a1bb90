#pragma once

#include <cstddef>

#include "core/result.hpp"
#include "server/dataset/dataset.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::server {

/// Opens a data set and checks that every file exists; the content of the images is not checked.
/// Sorts images that are not in order of time. Of images with the same time it keeps the first.
/// `warnings` counts both.
/// Errors: kInvalidArgument for options, a missing calibration or a folder of unknown layout;
/// kNotFound; kUnreadable naming file, line and value.
[[nodiscard]] Result<Dataset> open_dataset(const DatasetOptions& options);

/// Reads image `i` as the estimator gets it: 8-bit grey, with its CRC-32.
/// Errors: kNotFound; kUnreadable naming the image and the line that lists it, if the file is not
/// an image, is damaged, or differs in size from the calibration.
[[nodiscard]] Result<VoFrame> read_frame(const Dataset& dataset, std::size_t i);

}  // namespace overfly::server
