#include "server/calibration/calibration_file.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "server/files/whole_file.hpp"
#include "server/record/rows/run_rows.hpp"

namespace overfly::server {

namespace {

using Json = nlohmann::json;

}  // namespace

Result<CameraModel> read_calibrated_camera(const std::filesystem::path& file) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{16} << 20U;
  const Result<Json> value = read_json(file, kMaxBytes);
  if (!value) return value.error();
  const bool known = value->is_object() && value->value("format", Json()) == kCalibrationFormat &&
                     value->value("format_version", Json()) == kCalibrationFormatVersion;
  if (!known) {
    return Error{ErrorCode::kUnreadable,
                 file.string() + ": format and format_version must be \"" + kCalibrationFormat +
                     "\" and " + std::to_string(kCalibrationFormatVersion)};
  }
  Result<CameraModel> camera = camera_model_from(*value);
  if (!camera) return Error{ErrorCode::kUnreadable, camera.error().in(file.string()).message};
  if (Status valid = camera->validate(); !valid) {
    return Error{ErrorCode::kUnreadable, valid.error().in(file.string()).message};
  }
  return camera;
}

}  // namespace overfly::server
