// The photometric calibration of a run's cameras, in the format that photometric odometry (DSO)
// reads.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/record/rows/run_rows.hpp"
#include "server/scenario/camera_spec.hpp"

namespace overfly::server {

/// photometric/NAME, for a camera with a sensor model.
[[nodiscard]] std::filesystem::path calibration_folder(const std::filesystem::path& run_folder,
                                                       const std::string& camera);

/// Writes pcalib.txt and vignette.png; nothing for a camera without a sensor model.
/// Errors: kIo naming the file.
[[nodiscard]] Status write_calibration(const std::filesystem::path& run_folder,
                                       const CameraSpec& camera);

/// Writes times.txt: number, stamp given to estimators [s] and exposure [ms] of every delivered
/// frame, as many lines as there are recorded images. Nothing without a sensor model.
/// Errors: kIo naming the file.
[[nodiscard]] Status write_times(const std::filesystem::path& run_folder,
                                 const CameraSpec& camera,
                                 const std::vector<FrameRow>& frames);

}  // namespace overfly::server
