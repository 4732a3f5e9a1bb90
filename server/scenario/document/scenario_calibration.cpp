#include "server/scenario/document/scenario_calibration.hpp"

#include <string>

#include "server/calibration/calibration_file.hpp"
#include "server/record/rows/run_rows.hpp"
#include "server/scenario/document/scenario_field.hpp"
#include "server/scenario/document/scenario_layers.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

Status read_calibration(Json& camera,
                        const std::string& path,
                        const FileResolver& files,
                        const SourcePolicy& sources) {
  for (const char* field :
       {"width_px", "height_px", "fov_deg", "fov_axis", "fx_px", "distortion"}) {
    if (!camera.contains(field)) continue;
    return bad_field(path + "." + field,
                     camera.at(field),
                     "not be given with " + path + ".calibration, which determines it");
  }
  const std::filesystem::path file = files.resolve(camera.at("calibration"));
  if (Status status = sources.check(file, path + ".calibration"); !status) return status;
  const Result<CameraModel> model = read_calibrated_camera(file);
  if (!model) {
    // The scenario names a file that is no calibration: an error of the scenario.
    const Error error = model.error().in(path + ".calibration");
    const bool no_camera = error.code == ErrorCode::kUnreadable;
    return no_camera ? Error{ErrorCode::kInvalidArgument, error.message} : error;
  }
  camera.erase("calibration");
  camera.update(json_from(*model));
  if (model->distortion().none()) camera.erase("distortion");
  return {};
}

}  // namespace

Status read_calibrations(Json& document,
                         const std::filesystem::path& base,
                         const SourcePolicy& sources) {
  const FileResolver files(document, base);
  if (document.contains("camera") && document.at("camera").contains("calibration")) {
    Status status = read_calibration(document.at("camera"), "camera", files, sources);
    if (!status) return status;
  }
  if (!document.contains("cameras")) return {};
  Json& cameras = document.at("cameras");
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (!cameras[i].contains("calibration")) continue;
    const std::string path = "cameras." + std::to_string(i);
    if (Status status = read_calibration(cameras[i], path, files, sources); !status) return status;
  }
  return {};
}

}  // namespace overfly::server
