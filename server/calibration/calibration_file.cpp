#include "server/calibration/calibration_file.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "server/files/whole_file.hpp"
#include "server/record/rows/run_rows.hpp"

namespace overfly::server {

namespace {

using Json = nlohmann::json;

/// Most files that are given by mistake are calibrations of other programs.
constexpr const char* kExpected =
    " (must be a calibration file of Overfly, JSON written by `overfly calibrate --out`; files of "
    "Kalibr, OpenCV or COLMAP are not read)";

}  // namespace

Result<CameraModel> read_calibrated_camera(const std::filesystem::path& file) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{16} << 20U;
  const Result<Json> value = read_json(file, kMaxBytes);
  if (!value && value.error().code == ErrorCode::kUnreadable) {
    return Error{ErrorCode::kUnreadable, value.error().message + kExpected};
  }
  if (!value) return value.error();
  const bool known = value->is_object() && value->value("format", Json()) == kCalibrationFormat &&
                     value->value("format_version", Json()) == kCalibrationFormatVersion;
  if (!known) {
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": format and format_version must be \"" + kCalibrationFormat +
                     "\" and " + std::to_string(kCalibrationFormatVersion) + kExpected};
  }
  Result<CameraModel> camera = camera_model_from(*value);
  if (!camera) return Error{ErrorCode::kUnreadable, camera.error().in(file.string()).message};
  if (Status valid = camera->validate(); !valid) {
    return Error{ErrorCode::kUnreadable, valid.error().in(file.string()).message};
  }
  return camera;
}

}  // namespace overfly::server
