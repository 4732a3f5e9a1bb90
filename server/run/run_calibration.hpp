// The photometric calibration of a run's cameras, as photometric odometry (DSO) loads it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/record/run_rows.hpp"
#include "server/scenario/camera_spec.hpp"

namespace overfly::engine {

/// photometric/NAME, of a camera with a sensor model.
[[nodiscard]] std::filesystem::path calibration_folder(const std::filesystem::path& run_folder,
                                                       const std::string& camera);

/// pcalib.txt and vignette.png there; nothing of a camera without a sensor model.
/// Errors: kIo naming the file.
[[nodiscard]] Status write_calibration(const std::filesystem::path& run_folder,
                                       const CameraSpec& camera);

/// times.txt there: number, stamp that estimators were told [s] and exposure [ms] of every frame
/// that reached them, as many as there are recorded images. Nothing without a sensor model.
/// Errors: kIo naming the file.
[[nodiscard]] Status write_times(const std::filesystem::path& run_folder,
                                 const CameraSpec& camera,
                                 const std::vector<FrameRecord>& frames);

}  // namespace overfly::engine
