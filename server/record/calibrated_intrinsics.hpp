// The intrinsics that a run hands to its estimators in place of a camera's true ones.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "core/camera/camera_model.hpp"
#include "server/files/file_field.hpp"

namespace overfly::server {

struct CalibratedIntrinsics {
  /// Standard deviations of the model's parameters by the noise of the corners.
  struct Deviation {
    double fx_px = 0.0;
    double fy_px = 0.0;
    double cx_px = 0.0;
    double cy_px = 0.0;
    std::array<double, 5> k{};  ///< as Distortion::k
  };
  CameraModel model;
  Deviation deviation;
  double rms_px = 0.0;  ///< of the corners of the virtual board
  int views = 0;
  /// Distances between the projections of rays by the true model and by this one.
  double mean_difference_px = 0.0;
  double max_difference_px = 0.0;
};

/// The field `calibrated` of a camera in a manifest. @param truth  the camera's true model
[[nodiscard]] nlohmann::json json_from(const CalibratedIntrinsics& intrinsics,
                                       const CameraModel& truth);
/// Throws FieldViolation.
[[nodiscard]] CalibratedIntrinsics read_calibrated_intrinsics(const FileField& field);

/// "fx 700.021 (true 700.006), ...; projections differ by 0.05 px on average, by 0.21 px at most".
[[nodiscard]] std::string calibrated_words(const CalibratedIntrinsics& intrinsics,
                                           const CameraModel& truth);

}  // namespace overfly::server
