// A camera's calibration with its evidence, and its JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calibration/calibration.hpp"
#include "calibration/calibrator.hpp"
#include "core/camera/camera_model.hpp"

namespace overfly::server {

/// An image that gave no view.
struct LeftOutImage {
  std::string name;
  std::string reason;
};

struct CalibrationRecord {
  std::string source;  ///< the folder, or the scenario and its camera
  calibration::CalibratorOptions options;
  calibration::Calibration result;
  std::vector<std::string> names;  ///< of the views
  std::vector<LeftOutImage> left_out;
  std::optional<CameraModel> truth;  ///< of a virtual camera
};

/// Facts that a user should know: bars that are not full, outliers, a model that folds within the
/// image.
[[nodiscard]] std::vector<std::string> warnings_of(const CalibrationRecord& record);

/// The camera has the fields of a scenario's camera; the file is described in docs/CALIBRATION.md.
[[nodiscard]] nlohmann::json json_from(const CalibrationRecord& record);

}  // namespace overfly::server
