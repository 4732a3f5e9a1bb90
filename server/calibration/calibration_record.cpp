#include "server/calibration/calibration_record.hpp"

#include <cmath>

#include "server/calibration/calibration_file.hpp"
#include "server/record/rows/run_rows.hpp"

namespace overfly::server {
namespace {

using Json = nlohmann::json;

Json deviation_json(const calibration::CameraDeviation& deviation, const Distortion& distortion) {
  Json coefficients = Json::array();
  for (int i = 0; i < coefficient_count(distortion.model); ++i) {
    coefficients.push_back(deviation.k[static_cast<std::size_t>(i)]);
  }
  return {{"fx_px", deviation.fx_px},
          {"fy_px", deviation.fy_px},
          {"cx_px", deviation.cx_px},
          {"cy_px", deviation.cy_px},
          {"coefficients", std::move(coefficients)}};
}

Json views_json(const CalibrationRecord& record) {
  Json views = Json::array();
  for (std::size_t i = 0; i < record.names.size(); ++i) {
    const calibration::CalibratedView& view = record.result.views[i];
    views.push_back({{"image", record.names[i]},
                     {"rms_px", view.rms_px},
                     {"max_px", view.max_px},
                     {"tilt_deg", deg_from_rad(view.tilt_rad)},
                     {"outlier", view.outlier},
                     {"T_camera_board", json_from(view.T_camera_board)}});
  }
  return views;
}

Json coverage_json(const std::vector<calibration::CoverageBar>& bars) {
  Json value = Json::object();
  for (const calibration::CoverageBar& bar : bars) {
    value[bar.name] = {{"min", bar.min}, {"max", bar.max}, {"progress", bar.progress}};
  }
  return value;
}

}  // namespace

std::vector<std::string> warnings_of(const CalibrationRecord& record) {
  std::vector<std::string> warnings;
  for (const calibration::CoverageBar& bar : record.result.coverage) {
    constexpr double kEnough = 0.8;
    if (bar.progress >= kEnough) continue;
    warnings.push_back("coverage in " + bar.name + " is " +
                       std::to_string(std::lround(100.0 * bar.progress)) +
                       " %: more different views give a more certain result");
  }
  for (std::size_t i = 0; i < record.names.size(); ++i) {
    if (!record.result.views[i].outlier) continue;
    warnings.push_back(record.names[i] + ": does not fit the other views, was left out");
  }
  if (Status valid = record.result.camera.validate(); !valid) {
    warnings.push_back("no scenario can use this camera: " + valid.error().message);
  }
  return warnings;
}

Json json_from(const CalibrationRecord& record) {
  const calibration::Calibration& result = record.result;
  Json value = json_from(result.camera);
  value["format"] = kCalibrationFormat;
  value["format_version"] = kCalibrationFormatVersion;
  value["source"] = record.source;
  value["board"] = {{"cols", record.options.board.cols},
                    {"rows", record.options.board.rows},
                    {"square_m", record.options.board.square_m}};
  if (const auto& markers = record.options.board.markers) {
    const std::string bits = std::to_string(markers->bits);
    value["board"]["dictionary"] = "DICT_" + bits + "X" + bits + "_250";
    value["board"]["marker_m"] = markers->side_m;
  }
  value["standard_deviation"] = deviation_json(result.deviation, result.camera.distortion());
  value["rms_px"] = result.rms_px;
  value["max_px"] = result.max_px;
  value["coverage"] = coverage_json(result.coverage);
  value["views"] = views_json(record);
  Json left_out = Json::array();
  for (const LeftOutImage& image : record.left_out) {
    left_out.push_back({{"image", image.name}, {"reason", image.reason}});
  }
  value["left_out"] = std::move(left_out);
  value["warnings"] = warnings_of(record);
  if (record.truth) value["truth"] = json_from(*record.truth);
  return value;
}

}  // namespace overfly::server
