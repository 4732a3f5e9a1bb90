// The photometric calibration of a modelled sensor, in the form of the TUM monoVO data set
// (Engel, Usenko, Cremers 2016, arXiv:1607.02555, section III), which DSO loads.
#pragma once

#include <array>
#include <filesystem>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "sensor/sensor_model.hpp"

namespace overfly::sensor {

/// Irradiance of each value of the 8-bit image (for a deeper sensor: at the middle of the numbers
/// with the same high 8 bits), scaled so that the last is 255. Strictly increasing. A black level
/// is included in the values; for photometric methods set it to 0.
[[nodiscard]] std::array<double, 256> inverse_response(const SensorModel& model);

/// The transmission of each pixel divided by the image's largest; 65535 = 1. Flat without a
/// vignette. Write it as a 16-bit PNG, `vignette.png`.
/// @pre Sensor::create accepts model and camera
[[nodiscard]] Image16 vignette_map(const SensorModel& model, const CameraModel& camera);

/// `pcalib.txt`: the 256 values of inverse_response in one line. Errors: kIo naming the file.
[[nodiscard]] Status write_pcalib(const std::filesystem::path& file, const SensorModel& model);

}  // namespace overfly::sensor
